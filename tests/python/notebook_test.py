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


class Documentation(unittest.TestCase):
    def test_examples_run_one_after_the_other(self):
        text = (PYTHON / "README.md").read_text()
        blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
        self.assertGreater(len(blocks), 4)
        names = {}
        before = os.getcwd()
        os.chdir(ROOT)
        try:
            for block in blocks:
                with self.subTest(block=block):
                    exec(compile(block.replace('"out/', f'"{WORK}/out/'), "README.md", "exec"), names)
        finally:
            os.chdir(before)

    def test_the_table_of_columns_is_that_of_the_program(self):
        import minamo

        units = {entry["name"]: entry["unit"] for entry in minamo.list("components")}
        rows = re.findall(r"^\| `([a-z_.]+)` \| [^|]*\| ([^|]*) \|", (PYTHON / "README.md").read_text(), re.MULTILINE)
        self.assertGreater(len(rows), 8)
        for name, unit in rows:
            self.assertEqual(units[name], unit, name)


if __name__ == "__main__":
    unittest.main()
