"""Pools of tests/rest_by_chance.py: the same for the same number, at rest with the program and moved by another force.
In the environment: PROGRAM, WORK."""

import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

import rest_by_chance
from support.stand_in import with_arguments

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = os.environ["PROGRAM"]
WORK = Path(os.environ["WORK"])


def look_at(program, *arguments):
    return subprocess.run([sys.executable, "-B", ROOT / "tests/rest_by_chance.py", program, *arguments],
                          capture_output=True, text=True, check=False)


class RestByChance(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(WORK, ignore_errors=True)
        WORK.mkdir(parents=True)

    def test_a_number_is_a_pool(self):
        for kind in rest_by_chance.KINDS:
            scenes = [rest_by_chance.pool(kind, number, 1, 1) for number in (1, 1, 2)]
            self.assertEqual(scenes[0], scenes[1])
            self.assertNotEqual(scenes[0], scenes[2])

    def test_water_rests(self):
        done = look_at(PROGRAM, "--count", "2", "--end", "1")
        self.assertEqual((done.returncode, done.stdout.splitlines()[-1]), (0, "0 of 8 pools move, 0 fail"), done.stdout)

    def test_what_moves_is_told(self):
        pushed = with_arguments(WORK / "pushed", PROGRAM, "--set", '"/body_force=[2, -9.81]"')
        done = look_at(pushed, "--count", "1", "--end", "0.6", "--kinds", "tank,post")
        self.assertEqual((done.returncode, done.stdout.splitlines()[-1]), (0, "2 of 2 pools move, 0 fail"), done.stdout)

    def test_what_fails_is_told(self):
        done = look_at("/bin/false", "--count", "1", "--kinds", "beach")
        self.assertEqual((done.returncode, done.stdout.splitlines()[-1]), (1, "0 of 1 pools move, 1 fail"))

    def test_wrong_arguments(self):
        for arguments, words in ((["--kinds", "sea"], "no kind of pool: sea; there are beach"),
                                 (["--end", "0.5"], "are over before the start has settled")):
            done = look_at(PROGRAM, *arguments)
            self.assertEqual(done.returncode, 2)
            self.assertIn(words, done.stderr)


if __name__ == "__main__":
    unittest.main()
