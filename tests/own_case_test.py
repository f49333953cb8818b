"""The page "Your own case": its scene, its commands, its figures, its messages. In the environment: PROGRAM, WORK."""

import csv
import os
import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TEXT = (ROOT / "scenes/OWN_CASE.md").read_text()
WORK = Path(os.environ["WORK"])
PYTHON = [sys.executable, "-P", "-B"]
TOOLS = {"tools/figures": [*PYTHON, "-m", "figuring"], "tools/compare": [*PYTHON, "-m", "comparing"],
         "tools/report": [*PYTHON, ROOT / "tools/report"]}
COMMANDS = re.findall(r"^    (tools/.*)$", TEXT, re.MULTILINE)


def executable(command):
    """As a user calls it, without looking for packages and building."""
    tool, *arguments = [word.strip("'") for word in re.findall(r"'[^']*'|\S+", command)]
    if tool == "tools/run":
        first = [] if arguments[0] in ("check", "graph") else ["run"]
        return [os.environ["PROGRAM"], *first, *arguments, *(["--threads", "1"] if first else [])]
    return [*TOOLS[tool], *arguments]


class OwnCase(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(WORK, ignore_errors=True)
        WORK.mkdir(parents=True)
        (WORK / "sluice.json").write_text(re.search(r"```json\n(.*?)```", TEXT, re.DOTALL)[1])
        cls.done = [subprocess.run(list(map(str, executable(command))), cwd=WORK, capture_output=True, text=True,
                                   env=os.environ | {"PYTHONPATH": str(ROOT / "tools")}) for command in COMMANDS]

    def test_every_command_does_what_it_should(self):
        self.assertGreaterEqual(len(COMMANDS), 7)
        for command, done in zip(COMMANDS, self.done):
            with self.subTest(command=command):
                self.assertEqual(done.returncode, 0, done.stderr)
        for result in ("coarse/figures/speed.png", "coarse/report.html", "fine/compare/compare.png"):
            self.assertTrue((WORK / "out" / result).is_file(), result)

    def test_the_differences_are_those_of_the_page(self):
        with open(WORK / "out/fine/compare/compare.csv") as file:
            measured = {(row["quantity"], row["figure"]): float(row["value"]) for row in csv.DictReader(file)}
        rows = re.findall(r"^\| (\w+), [^|]*\| ([\d.]+) % \| ([\d.]+) % \|$", TEXT, re.MULTILINE)
        self.assertEqual(len(rows), 3)
        for column, *told in rows:
            for figure, percent in zip(("rms over range", "largest over range"), told):
                with self.subTest(column=column, figure=figure):
                    # Splashes differ from compiler to compiler.
                    self.assertLess(abs(100 * measured[column, figure] / float(percent) - 1), 0.3)

    def test_messages_are_those_of_the_program(self):
        sources = "\n".join(path.read_text() for folder in ("engine", "systems", "tools")
                            for path in (ROOT / folder).rglob("*.cpp"))
        cells = re.findall(r"^\| (`[^|]*`) \|", TEXT, re.MULTILINE)
        self.assertGreater(len(cells), 8)
        for message in re.findall(r"`([^`]*)`", " ".join(cells)):
            for part in filter(None, map(str.strip, message.split("..."))):
                self.assertTrue(part in sources, f"no message of the program has: {part}")


if __name__ == "__main__":
    unittest.main()
