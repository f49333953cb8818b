"""scenes/OWN_CASE.md: its scene is valid, its commands run in their order, what it quotes is what the program says. In
the environment: PROGRAM, WORK."""

import os
import re
import shlex
import shutil
import subprocess
import sys
import unittest
from pathlib import Path
from unittest.mock import patch

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "tests/support"), str(ROOT / "tools")]
import comparing.__main__  # noqa: E402, F401  for call()
import figuring.__main__  # noqa: E402, F401
from forked import call  # noqa: E402

PROGRAM = os.environ["PROGRAM"]
WORK = Path(os.environ["WORK"])
PAGE = (ROOT / "scenes/OWN_CASE.md").read_text()
# What wrappers call that install packages.
MODULES = {"tools/report": "reporting", "tools/figures": "figuring", "tools/compare": "comparing"}
COMMANDS = ("check", "graph", "list", "schema", "study")  # of tools/run; whatever else is a scene
LONG = "[400, 100]"  # the grid of a run that takes half a minute: here its first steps alone


def indented():
    """Lines of code that stand indented in the page."""
    outside = re.sub(r"```.*?```", "", PAGE, flags=re.DOTALL)
    return [line[4:] for line in outside.splitlines() if line.startswith("    ")]


def run(command):
    """A command of the page in WORK, with the program in the place of tools/run."""
    tool, *arguments = shlex.split(command)
    environment = os.environ | {"PYTHONPATH": str(ROOT / "tools"), "MINAMO": PROGRAM}
    if tool in MODULES:
        # Plots of all histories and systems take half of the time, and figures_test.py has them.
        with patch("figuring.plots.draw_history", return_value=None), patch("figuring.plots.draw_systems",
                                                                            return_value=None):
            return call(MODULES[tool], arguments, WORK, environment)
    if tool != "tools/run":
        return call(ROOT / tool, arguments, WORK, environment)
    if arguments[0] not in COMMANDS:
        arguments = ["run", *arguments, "--threads", "1", "--quiet"]
    if any(LONG in argument for argument in arguments):
        arguments += ["--set", "/time/end=0.06"]
    return subprocess.run([PROGRAM, *arguments], cwd=WORK, capture_output=True, text=True, check=False)


def strings_of_the_sources():
    """All texts of the sources, one after the other; those that the compiler joins are joined."""
    texts = []
    for folder in ("engine", "systems", "tools"):
        for path in sorted((ROOT / folder).rglob("*.cpp")):
            source = re.sub(r'(?<!\\)"\s*\n\s*"', "", path.read_text())
            texts += re.findall(r'"((?:[^"\\\n]|\\.)*)"', source)
    return [text.replace('\\"', '"') for text in texts]


class OwnCase(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(WORK, ignore_errors=True)
        WORK.mkdir(parents=True)
        (WORK / "sluice.json").write_text(re.search(r"```json\n(.*?)```", PAGE, re.DOTALL)[1])
        cls.commands = [line for line in indented() if line.startswith("tools/")]
        cls.done = {command: run(command) for command in cls.commands}

    def test_every_command_runs_without_a_word_of_trouble(self):
        self.assertGreaterEqual(len(self.commands), 9)
        for tool in ("tools/run check", "tools/run sluice.json", *MODULES):
            self.assertTrue(any(command.startswith(tool) for command in self.commands), tool)
        for command, done in self.done.items():
            with self.subTest(command):
                self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_the_files_that_the_page_names_are_there(self):
        for name in ("report.html", "fields.xdmf", "history.csv", "summary.json", "figures/speed.png"):
            self.assertTrue((WORK / "out/coarse" / name).is_file(), name)
        self.assertTrue((WORK / "out/fine/compare/compare.png").is_file())

    def test_check_says_what_the_page_says_that_it_does(self):
        said = [line.rstrip() for line in self.done["tools/run check sluice.json"].stdout.splitlines()]
        begin = indented().index(said[0])
        quoted = [line.rstrip() for line in indented()[begin:begin + len(said)]]
        for line, other in zip(said, quoted):
            if line.startswith(("  memory", "  disk")):
                line, other = (text.split(" of ")[0] for text in (line, other))
            self.assertEqual(line, other)

    def test_the_differences_are_those_of_the_page(self):
        out = next(self.done[command].stdout for command in self.commands if "compare out/coarse out/fine " in command)
        for name, place, tolerance in (("gate_force_x", 3, 0.3), ("floor_pressure", 3, 0.3), ("step_force_x", 3, 0.5),
                                       ("coarse", 1, 0.3)):
            quoted, found = (next(line.split() for line in lines if re.match(name + " (?! *less)", line))
                             for lines in (indented(), out.splitlines()))
            # Processors round differently, and a splash makes much of it.
            self.assertAlmostEqual(float(found[place]) / float(quoted[place]), 1, delta=tolerance, msg=name)

    def test_every_message_of_the_page_is_one_of_the_sources(self):
        table = PAGE.split("| message | cause | change |")[1].split("\n\n")[0]
        messages = re.findall(r"^\| `([^`]+)` \|", table, re.MULTILINE)
        self.assertGreater(len(messages), 12)
        sources = strings_of_the_sources()
        for message in messages:
            parts = re.split(r"(?<![^ ])-", message)
            pattern = re.compile(".*".join(re.escape(part.strip()) for part in parts))
            self.assertTrue(any(pattern.search(text) for text in sources), message)

    def test_the_page_is_short(self):
        self.assertLessEqual(len(re.sub(r"`[^`]*`", "code", self.without_code()).split()), 1500)

    def without_code(self):
        outside = re.sub(r"```.*?```", "", PAGE, flags=re.DOTALL)
        return "\n".join(line for line in outside.splitlines() if not line.startswith("    "))


if __name__ == "__main__":
    unittest.main()
