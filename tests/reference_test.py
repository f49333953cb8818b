"""The reference that tools/reference writes: it is that of the sources, and what has no description is an error. In the
environment: WORK."""

import os
import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
WORK = Path(os.environ["WORK"])
DOXYFILE = "tools/referencing/Doxyfile"


def sources():
    """The files that Doxygen reads, as the Doxyfile lists them."""
    text = (ROOT / DOXYFILE).read_text().replace("\\\n", " ")
    return re.search(r"^INPUT +=(.*)", text, re.MULTILINE)[1].split()


def copied(name):
    """A tree with all that the reference is made of, to change it."""
    tree = WORK / name
    shutil.rmtree(tree, ignore_errors=True)
    for path in [*sources(), DOXYFILE]:
        (tree / path).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / path, tree / path)
    for folder in ("example_system", "example_scheme", "referencing", "python/package"):
        shutil.copytree(ROOT / "tools" / folder, tree / "tools" / folder, dirs_exist_ok=True)
    (tree / "out").mkdir()
    return tree


def change(path, old, new):
    """Replaces a text that is there once."""
    text = path.read_text()
    assert text.count(old) == 1, f"{old} is there {text.count(old)} times in {path}"
    path.write_text(text.replace(old, new))


def python_page(tree, *arguments):
    """Calls what writes the page of the Python module."""
    return subprocess.run([sys.executable, "-P", "-B", "-m", "referencing", *arguments], cwd=tree, text=True,
                          capture_output=True, check=False, env=os.environ | {"PYTHONPATH": str(tree / "tools")})


def doxygen(tree):
    """Writes the pages of a tree."""
    return subprocess.run(["doxygen", DOXYFILE], cwd=tree, text=True, capture_output=True, check=False)


class PythonPage(unittest.TestCase):
    def test_the_page_of_the_module_is_what_its_docstrings_say(self):
        done = python_page(ROOT, "--check")
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_another_docstring_makes_the_page_old(self):
        tree = copied("old")
        change(tree / "tools/python/package/minamo/simulation.py", '"""Accepted steps."""', '"""Steps."""')
        done = python_page(tree, "--check")
        self.assertEqual((done.returncode, done.stderr),
                         (2, "tools/python/REFERENCE.md is not what the docstrings say: call tools/reference\n"))
        self.assertEqual(python_page(tree).returncode, 0)
        self.assertIn("\n\nSteps.\n\n", (tree / "tools/python/REFERENCE.md").read_text())
        self.assertEqual(python_page(tree, "--check").returncode, 0)

    def test_all_that_is_not_described_is_told(self):
        tree = copied("undescribed")
        package = tree / "tools/python/package/minamo"
        change(package / "simulation.py", '        """Accepted steps."""\n', "")
        change(package / "simulation.py", ":param every: steps", ":param often: steps")
        change(package / "__init__.py", '"Column", "Error",', '"Column", "Colour", "Error",')
        done = python_page(tree)
        self.assertEqual(done.returncode, 2)
        faults = [re.sub(r"^tools/python/package/minamo/(\w+\.py)(:\d+)?: ", r"\1: ", line)
                  for line in done.stderr.splitlines()]
        self.assertEqual(faults, [
            "simulation.py: the docstring of Simulation.watch describes often, which is no parameter of it",
            "simulation.py: Simulation.steps has no docstring",
            "__init__.py: exports Colour, which no section of the reference has"])


@unittest.skipUnless(shutil.which("doxygen"), "doxygen is not there")
class Pages(unittest.TestCase):
    def test_every_header_that_extensions_include_is_in_it(self):
        included = set()
        for path in [ROOT / "tools/program/minamo.hpp", *ROOT.glob("tools/example_*/main.cpp")]:
            included |= set(re.findall(r'#include ["<](?:minamo/)?((?:engine|components|systems)/[\w/]+\.hpp)',
                                       path.read_text()))
        self.assertGreater(len(included), 15)
        self.assertEqual(included - set(sources()), set())

    def test_the_start_page_shows_code_of_the_examples_with_links(self):
        tree = copied("pages")
        done = doxygen(tree)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        page = (tree / "out/reference/index.html").read_text()
        fragments = re.findall(r'<div class="fragment">(.*?)</div><!-- fragment -->', page, re.DOTALL)
        shown = [re.sub(r"<[^>]*>", "", fragment) for fragment in fragments]
        for expected in ("#include &lt;minamo/minamo.hpp&gt;", "struct MeanHeight", "struct MeasureMeanHeight",
                         "struct LogMeanHeight", "log_mean_height&quot;);\n", "in.number(&quot;strain&quot;",
                         "&quot;after&quot;"):
            with self.subTest(expected=expected):
                self.assertEqual(sum(expected in text for text in shown), 1)
        for name in ("structminamo_1_1Read", "structminamo_1_1particle_1_1Position", "classminamo_1_1SystemRegistry"):
            self.assertIn(name, "".join(fragments))
        # A name that is not there stays a plain word.
        text = re.sub(r'<div class="fragment">.*?</div><!-- fragment -->|<a [^>]*>[^<]*</a>', "", page, flags=re.DOTALL)
        self.assertEqual(re.findall(r"minamo::\w+", re.sub(r"<[^>]*>", "", text)), [])

    def test_a_member_without_description_is_an_error(self):
        tree = copied("member")
        change(tree / "engine/run/clock.hpp", "  double step = 0; ", "  double pace = 0;\n  double step = 0; ")
        done = doxygen(tree)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("engine/run/clock.hpp:12: error: Member pace (variable) of struct minamo::Clock is not documented",
                      done.stderr)


if __name__ == "__main__":
    unittest.main()
