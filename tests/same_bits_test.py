"""What tests/same_bits.py says of a program and itself, and of two that differ. In the environment: PROGRAM, WORK."""

import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

from support.stand_in import with_arguments

ROOT = Path(__file__).resolve().parent.parent
SCENE = ROOT / "scenes/dam_break.json"
PROGRAM = os.environ["PROGRAM"]
WORK = Path(os.environ["WORK"])


def program(name, *arguments):
    """A program that is minamo with further arguments."""
    return with_arguments(WORK / name, PROGRAM, *arguments)


def compare(after, *arguments):
    return subprocess.run([sys.executable, ROOT / "tests/same_bits.py", PROGRAM, after, "--steps", "3", *arguments],
                          capture_output=True, text=True, check=False)


class SameBits(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(WORK, ignore_errors=True)
        WORK.mkdir(parents=True)

    def test_a_program_is_the_same_as_itself(self):
        done = compare(PROGRAM, SCENE)
        self.assertEqual((done.returncode, done.stdout), (0, "1 scenes are the same, 0 differ, 0 fail\n"))

    def test_another_viscosity_is_told(self):
        done = compare(program("thicker", "--set", "/fluid/viscosity=0.0011"), SCENE)
        self.assertEqual(done.returncode, 1)
        self.assertIn("dam_break.json: differs in history.csv, ", done.stdout)
        self.assertIn("particle.velocity", done.stdout)

    def test_an_error_of_one_is_told(self):
        done = compare(program("broken", "--no-such-option"), SCENE)
        self.assertEqual(done.returncode, 1)
        self.assertIn("exit code and words", done.stdout)

    def test_a_scene_that_fails_with_both_is_not_the_same(self):
        done = compare(PROGRAM, WORK / "no_such_scene.json")
        self.assertEqual(done.returncode, 1)
        self.assertIn("fails with both", done.stdout)


if __name__ == "__main__":
    unittest.main()
