"""The notebooks, run without a screen, and the examples of the documentation."""

import json
import os
import re
import sys
import tempfile
import unittest
from pathlib import Path

from support import ROOT, WORK

PYTHON = ROOT / "tools/python"


def executed(name, *cells):
    """A notebook after all its cells have run, and then further ones; checks what holds for every notebook."""
    import nbformat
    from nbclient import NotebookClient

    notebook = nbformat.read(PYTHON / name, as_version=4)
    assert not any(cell.get("outputs") for cell in notebook.cells), f"{name}: the file has outputs"
    notebook.cells += map(nbformat.v4.new_code_cell, cells)
    # A kernel of the python that runs this, whatever kernels the machine has.
    with tempfile.TemporaryDirectory() as jupyter:
        kernel = Path(jupyter) / "kernels/python3"
        kernel.mkdir(parents=True)
        (kernel / "kernel.json").write_text(json.dumps(
            {"argv": [sys.executable, "-m", "ipykernel_launcher", "-f", "{connection_file}"], "language": "python",
             "display_name": "python"}))
        os.environ["JUPYTER_PATH"] = jupyter
        os.environ.pop("MPLBACKEND", None)  # the kernel has its own
        NotebookClient(notebook, timeout=300, kernel_name="python3",
                       resources={"metadata": {"path": str(PYTHON)}}).execute()
    nbformat.write(notebook, WORK / name)
    return notebook


def outputs(notebook):
    """Those of all cells."""
    return [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]


def pictures(notebook):
    """How many there are."""
    return sum("image/png" in output.get("data", {}) for output in outputs(notebook))


class Notebook(unittest.TestCase):
    def setUp(self):
        try:
            import ipykernel  # noqa: F401
            import nbclient  # noqa: F401
        except ImportError:
            self.skipTest("python3-nbclient and python3-ipykernel are not there")

    def test_first_steps_have_a_history_a_sweep_and_a_surface_that_are_right(self):
        # Of a closed surface every edge is there in both directions.
        notebook = executed("first_steps.ipynb", "edges = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)\n"
                            "closed = set(map(tuple, edges)) == set(map(tuple, edges[:, ::-1]))\n"
                            "print(json.dumps([error, list(measured), list(2 * viscosities / rho * k**2), closed]))")
        self.assertLessEqual(len(notebook.cells) - 1, 12)
        self.assertEqual([o for o in outputs(notebook) if o.output_type == "error"], [])
        self.assertEqual(pictures(notebook), 4)
        error, measured, theory, closed = json.loads(outputs(notebook)[-1].text)
        self.assertLess(error, 0.014)  # 0.0071 was measured
        for decay, expected in zip(measured, theory):
            self.assertLess(abs(decay / expected - 1), 0.25)  # 0.124 was measured, of the largest viscosity
        self.assertTrue(closed)

    def test_transfer_schemes_run_to_their_picture(self):
        notebook = executed("transfer_schemes.ipynb")
        lines = [line for cell in notebook.cells if cell.cell_type == "code" for line in cell.source.splitlines()]
        self.assertLessEqual(len(lines), 20)
        self.assertEqual([o for o in outputs(notebook) if o.output_type == "error"], [])
        self.assertGreaterEqual(pictures(notebook), 2)

    def test_the_tool_opens_the_first_steps_and_names_the_other(self):
        text = (ROOT / "tools/notebook").read_text()
        self.assertIn(":-$root/tools/python/first_steps.ipynb}", text)
        for path in PYTHON.glob("*.ipynb"):
            self.assertIn(path.name, text)
            self.assertIn(path.name, (PYTHON / "README.md").read_text())


def printed_by(block, names):
    """Runs a block of code; what each of its lines printed, by number."""
    printed = {}

    def record(*values):
        printed[sys._getframe(1).f_lineno] = " ".join(map(str, values))

    names["print"] = record
    exec(compile(block.replace('"out/', f'"{WORK}/out/'), "README.md", "exec"), names)
    return printed


NUMBER = r"-?\d+\.\d+(?:e-?\d+)?"


def agrees(promised, printed):
    """Whether a comment says what was printed: numbers to their last digit there, `...` for what it leaves out."""
    words = promised.split()
    patterns = [".*" if word == "..." else NUMBER if re.fullmatch(NUMBER, word) else re.escape(word) for word in words]
    match = re.fullmatch(r"\s+".join(f"({pattern})" for pattern in patterns), printed, re.DOTALL)
    return bool(match) and all(pattern != NUMBER or rounded_as(word, got) == word
                               for word, pattern, got in zip(words, patterns, match.groups()))


def rounded_as(word, got):
    """A number with as many decimals as another."""
    return f"{float(got):.{len(word.partition('.')[2])}f}"


class Documentation(unittest.TestCase):
    def test_examples_run_one_after_the_other_and_print_what_they_say(self):
        self.expect_examples(PYTHON / "README.md", 4, 6)

    def test_examples_of_docstrings_do_so_too(self):
        self.expect_examples(PYTHON / "REFERENCE.md", 4, 6)

    def test_the_first_page_does_so_too(self):
        self.expect_examples(ROOT / "README.md", 0, 1)

    def expect_examples(self, page, more_than, at_least):
        """The blocks of a page run in one interpreter, and print what stands behind `->`."""
        blocks = re.findall(r"```python\n(.*?)```", page.read_text(), re.DOTALL)
        self.assertGreater(len(blocks), more_than)
        names, compared = {}, 0
        before = os.getcwd()
        os.chdir(ROOT)
        try:
            for block in blocks:
                with self.subTest(block=block):
                    printed = printed_by(block, names)
                    for number, line in enumerate(block.splitlines(), start=1):
                        if promised := re.search(r"# -> (.*)", line):
                            self.assertTrue(agrees(promised[1], printed[number]), f"{line}: printed {printed[number]}")
                            compared += 1
        finally:
            os.chdir(before)
        self.assertGreaterEqual(compared, at_least)

    def test_numbers_agree_to_the_digits_that_are_written(self):
        for promised, printed, expected in (("0.1 10", "0.1080741859755799 10", True), ("0.11", "0.10499", False),
                                            ("0.1, 50", "0.1080741859755799 10", False), ("10", "100", False),
                                            ("(3, 2) False", "(3, 2) False", True), ("a: ... c", "a:\n b c", True),
                                            ("a ... c", "a:\n b c", False)):
            with self.subTest(promised=promised, printed=printed):
                self.assertEqual(agrees(promised, printed), expected)

    def test_programs_to_copy_are_built_into_folders_of_their_own(self):
        folders = [set(re.findall(r"\bout/\w+", path.read_text())) for path in ROOT.glob("tools/example_*/README.md")]
        self.assertEqual([len(each) for each in folders], [1, 1, 1])
        self.assertEqual(len(set.union(*folders)), 3)

    def test_the_table_of_columns_is_that_of_the_program(self):
        import minamo

        units = {entry["name"]: entry["unit"] for entry in minamo.list("components")}
        rows = re.findall(r"^\| `([a-z_.]+)` \| [^|]*\| ([^|]*) \|", (PYTHON / "README.md").read_text(), re.MULTILINE)
        self.assertGreater(len(rows), 8)
        for name, unit in rows:
            self.assertEqual(units[name], unit, name)


if __name__ == "__main__":
    unittest.main()
