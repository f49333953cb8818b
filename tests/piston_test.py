"""tools/piston: its motions against the equations they come from."""

import json
import math
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PISTON = ROOT / "tools/piston"
sys.path.insert(0, str(ROOT / "tests/support"))
from forked import call  # noqa: E402


def run(*arguments):
    return call(PISTON, list(arguments))


def constants(height, period, depth, *more):
    done = run("--height", str(height), "--period", str(period), "--depth", str(depth), *more)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)["constants"]


class Piston(unittest.TestCase):
    def test_shallow_water_moves_as_a_whole(self):
        # H = 2 stroke k d, k d = omega (d/g)^(1/2).
        depth, period = 0.1, 20
        kd = 2 * math.pi / period * math.sqrt(depth / 9.81)
        self.assertAlmostEqual(constants(0.001, period, depth)["stroke"] * 2 * kd / 0.001, 1, delta=kd**2)

    def test_deep_water_has_waves_as_high_as_twice_the_way(self):
        self.assertAlmostEqual(constants(0.02, 0.5, 50)["stroke"], 0.02 / 4, delta=1e-6)

    def test_the_second_part_grows_with_the_square_of_the_height(self):
        low, high = (constants(height, 1.5708, 0.4)["second"] for height in (0.02, 0.04))
        self.assertAlmostEqual(high / low, 4, delta=1e-4)
        # H^2/(32 d) (3 cosh kd/sinh^3 kd - 2/m), kd = 0.906, m = 0.894, by hand.
        self.assertAlmostEqual(high, 2.07e-4, delta=2e-6)
        self.assertEqual(constants(0.04, 1.5708, 0.4, "--first-order")["second"], 0)

    def test_it_tells_where_the_theory_ends(self):
        self.assertIn("second order does not describe them", run("--height", "0.2", "--period", "4", "--depth", "0.4").stderr)
        self.assertIn("break at this height", run("--height", "0.3", "--period", "1", "--depth", "2").stderr)

    def test_bad_input_is_refused(self):
        for value in ("0", "-1", "x", "nan", "inf"):
            done = run("--height", value, "--period", "1", "--depth", "1")
            self.assertEqual(done.returncode, 2)
            self.assertIn(f'--height: expected a number above 0, got "{value}"', done.stderr)


if __name__ == "__main__":
    unittest.main()
