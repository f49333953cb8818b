"""tests/same_on_ranks.py, with programs that differ and scenes that are refused. In the environment: PROGRAM (minamo),
MPI_PROGRAM (minamo-mpi), WORK."""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import unittest
from unittest import mock

import numpy as np
import same_on_ranks
from support.stand_in import with_arguments

TESTS = pathlib.Path(__file__).resolve().parent
DAM_BREAK = TESTS.parent / "scenes/dam_break.json"
WORK = pathlib.Path(os.environ["WORK"])


class SameOnRanks(unittest.TestCase):
    def compare(self, program, scene, *options):
        return subprocess.run([sys.executable, "-B", TESTS / "same_on_ranks.py", program, os.environ["MPI_PROGRAM"], scene,
                               "--ranks", "2", "--steps", "2", *options], capture_output=True, text=True, timeout=120)

    def test_the_same_flow_is_alike(self):
        done = self.compare(os.environ["PROGRAM"], DAM_BREAK, "--twice")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("the same bits twice", done.stdout)
        self.assertIn("1 runs are alike, 0 differ or fail, 0 scenes are refused", done.stdout)

    def test_another_flow_differs(self):
        other = with_arguments(WORK / "heavier", os.environ["PROGRAM"], "--set", "/body_force=[0,-12]")
        done = self.compare(other, DAM_BREAK)
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertIn("dam_break.json, 2: DIFFERS, ", done.stdout)

    def test_a_run_differs_whatever_differs_most(self):
        arguments = argparse.Namespace(program="", mpi_program="", ranks=[2], within=1e-9, twice=False)
        for most in range(3):
            found = [0.0, 0.0, 0.0, np.float64(0.1)]
            found[most] = np.float64(1)
            with mock.patch.multiple(same_on_ranks, run=lambda *_: (0, ""), differences=lambda *_, of=found: of):
                [(_, is_alike, _)] = same_on_ranks.compare(DAM_BREAK, arguments, "")
            self.assertIs(is_alike, False)

    def test_a_scene_that_is_refused_is_named(self):
        scene = json.loads(DAM_BREAK.read_text(encoding="utf8"))
        scene.pop("$schema")
        scene["discretization"] = {"scheme": "equal_order"}
        path = WORK / "nodes.json"
        path.write_text(json.dumps(scene), encoding="utf8")
        done = self.compare(os.environ["PROGRAM"], path)
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertIn("nodes.json, 2: refused: ", done.stdout)
        self.assertIn("1 scenes are refused", done.stdout)


if __name__ == "__main__":
    WORK.mkdir(parents=True, exist_ok=True)
    unittest.main()
