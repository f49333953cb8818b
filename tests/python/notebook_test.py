"""The notebook, run without a screen, and the examples of the documentation."""

import json
import os
import re
import sys
import tempfile
import unittest
from pathlib import Path

from support import ROOT, WORK

PYTHON = ROOT / "tools/python"


class Notebook(unittest.TestCase):
    def test_runs_to_its_picture(self):
        try:
            import nbformat
            from nbclient import NotebookClient
        except ImportError:
            self.skipTest("python3-nbclient and python3-ipykernel are not there")
        path = PYTHON / "transfer_schemes.ipynb"
        notebook = nbformat.read(path, as_version=4)
        lines = [line for cell in notebook.cells if cell.cell_type == "code" for line in cell.source.splitlines()]
        self.assertLessEqual(len(lines), 20)
        self.assertFalse(any(cell.get("outputs") for cell in notebook.cells), "the file has no outputs")
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
        outputs = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]
        self.assertEqual([o for o in outputs if o.output_type == "error"], [])
        pictures = [o for o in outputs if "image/png" in o.get("data", {})]
        self.assertGreaterEqual(len(pictures), 2)
        nbformat.write(notebook, WORK / "transfer_schemes.ipynb")


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
        self.expect_examples("README.md")

    def test_examples_of_docstrings_do_so_too(self):
        self.expect_examples("REFERENCE.md")

    def expect_examples(self, page):
        """The blocks of a page run in one interpreter, and print what stands behind `->`."""
        blocks = re.findall(r"```python\n(.*?)```", (PYTHON / page).read_text(), re.DOTALL)
        self.assertGreater(len(blocks), 4)
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
        self.assertGreaterEqual(compared, 6)

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
