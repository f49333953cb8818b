"""What tools/compare finds between runs whose difference is known, and what it says of wrong input. In the environment:
PROGRAM, WORK."""

import csv
import json
import os
import shutil
import subprocess
import sys
import unittest
from contextlib import nullcontext
from math import sqrt
from pathlib import Path
from unittest.mock import patch

import h5py
import numpy as np
from matplotlib.image import imread

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "tests/support"), str(ROOT / "tools")]
import comparing.__main__  # noqa: E402, F401  for call()
from comparing.liquid import inside_of  # noqa: E402
from comparing.raster import Raster  # noqa: E402
from compare_interfoam import b_spline  # noqa: E402
from forked import call  # noqa: E402
from reporting.bodies import Body  # noqa: E402

PROGRAM = os.environ["PROGRAM"]
WORK = Path(os.environ["WORK"])
SIDE, COLUMN = 0.584, 0.146  # of the tank, and of the water in it [m]
GRIDS = {"coarse": 8, "middle": 16, "fine": 32}


def run_scene(folder, settings, *more):
    command = [PROGRAM, "run", ROOT / "scenes/dam_break.json", "--out", WORK / folder, "--threads", "1", "--quiet"]
    command += more
    for key, value in ({"/time/end": 0.1} | settings).items():
        command += ["--set", f"{key}={json.dumps(value)}"]
    subprocess.run(list(map(str, command)), stderr=subprocess.DEVNULL, check=True)


def compare(*arguments, drawn=b"not drawn"):
    """Calls the python part of tools/compare in WORK; without its picture, which takes most of the time."""
    with patch("comparing.picture.picture", return_value=drawn) if drawn else nullcontext():
        return call("comparing", list(map(str, arguments)), WORK, os.environ | {"PYTHONPATH": str(ROOT / "tools")})


def numbers_of(folder):
    """compare.csv: values by run, quantity and figure; several in the order of the file."""
    found = {}
    with (WORK / folder / "compare.csv").open() as file:
        for row in csv.DictReader(file):
            found.setdefault((row["run"], row["quantity"], row["figure"]), []).append(
                (float(row["time"] or "nan"), float(row["value"])))
    return found


def copy_of(run, folder):
    shutil.rmtree(WORK / folder, ignore_errors=True)
    shutil.copytree(WORK / run, WORK / folder)
    return WORK / folder


def set_column(folder, column, values):
    """Writes a column of a history anew; `values` of the times and of what is there."""
    path = folder / "history.csv"
    header, *rows = [line.split(",") for line in path.read_text().splitlines()]
    table = dict(zip(header, np.array(rows, float).T))
    table[column] = values(table["time"], table[column]) * np.ones(len(rows))
    lines = [header, *(map(repr, map(float, row)) for row in zip(*table.values()))]
    path.write_text("".join(",".join(line) + "\n" for line in lines))


class Compare(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(WORK, ignore_errors=True)
        WORK.mkdir(parents=True)
        for name, cells in GRIDS.items():
            run_scene(name, {"/grid/cells": [cells, cells]})
        run_scene("stopped", {"/grid/cells": [8, 8]}, "--steps", "2")
        run_scene("minimal", {"/grid/cells": [8, 8], "/output/fields": "minimal"})

    def expect_tables(self, *arguments, **how):
        done = compare(*arguments, **how)
        self.assertEqual(done.stderr, "")
        self.assertEqual(done.returncode, 0)
        return done.stdout

    def expect_error(self, message, *arguments):
        done = compare(*arguments)
        self.assertIn(message, done.stderr)
        self.assertEqual((done.returncode, done.stdout), (2, ""))

    def test_a_run_is_no_different_from_itself(self):
        out = self.expect_tables("middle", "middle", "--out", "itself")
        self.assertIn("The scenes are the same.", out)
        self.assertTrue(out.endswith("itself/compare.png\nitself/compare.csv\n"), out)
        found = numbers_of("itself")
        self.assertIn(("middle", "kinetic_energy", "rms"), found)
        self.assertNotIn(("middle", "iterations", "rms"), found)
        for (_, quantity, figure), values in found.items():
            if figure in ("rms", "largest", "rms over range", "largest over range", "S"):
                self.assertEqual({value for _, value in values}, {0.0}, (quantity, figure))
        self.assertEqual(len(found["middle", "misplaced_area", "S"]), 3)
        self.assertGreater(found["middle", "kinetic_energy", "range"][0][1], 1)

    def test_a_difference_that_is_made_up_is_found(self):
        other = copy_of("middle", "other")
        set_column(other, "max_speed", lambda t, v: v - 0.25)
        set_column(other, "kinetic_energy", lambda t, v: v + 10 * t)
        set_column(other, "momentum_x", lambda t, v: v + 3 * (np.arange(len(t)) == 2))
        self.expect_tables("other", "middle", "--out", "made_up")
        found = numbers_of("made_up")
        history = np.genfromtxt(WORK / "middle/history.csv", delimiter=",", names=True)
        self.assertAlmostEqual(found["other", "max_speed", "rms"][0][1], 0.25, 12)
        self.assertAlmostEqual(found["other", "max_speed", "largest over range"][0][1],
                               0.25 / np.ptp(history["max_speed"]), 12)
        self.assertAlmostEqual(found["other", "kinetic_energy", "rms"][0][1], 1 / sqrt(3), 12)
        time, largest = found["other", "kinetic_energy", "largest"][0]
        self.assertAlmostEqual(largest, 1, 12)
        self.assertAlmostEqual(time, 0.1, 12)
        time, largest = found["other", "momentum_x", "largest"][0]
        self.assertAlmostEqual(largest, 3, 12)
        self.assertEqual(time, history["time"][2])

    def test_the_common_time_and_the_chosen_columns_are_compared(self):
        run_scene("longer", {"/grid/cells": [16, 16], "/time/end": 0.15})
        out = self.expect_tables("longer", "middle", "--columns", "max_speed", "--at", "0.05")
        self.assertIn("from 0 to 0.1 s", out)
        found = numbers_of("middle/compare")
        self.assertEqual({quantity for _, quantity, _ in found}, {"max_speed", "raster", "misplaced_area"})
        self.assertLess(found["longer", "max_speed", "largest"][0][1], 1e-3)  # the last steps are cut otherwise
        self.assertRegex(out, r"\n/time/end +0\.15 +0\.1\n")

    def test_the_misplaced_area_of_a_block_that_was_moved_is_twice_its_way_over_its_width(self):
        way = 0.03
        for name, x in (("left", 0.2), ("right", 0.2 + way)):
            with h5py.File(copy_of("fine", name) / "fields.h5", "r+") as file:
                file["particles/0/position"][:, 0] += x
        out = self.expect_tables("left", "right", "--out", "moved")
        self.assertIn("B-spline of 0.01825 m", out)
        shares = numbers_of("moved")["left", "misplaced_area", "S"]
        self.assertAlmostEqual(shares[0][1], 2 * way / COLUMN, delta=0.02)
        self.assertEqual(shares[1][1], 0)

    def test_the_misplaced_area_is_that_of_compare_interfoam(self):
        for name, gravity in (("heavy", -9.81), ("light", -7)):
            run_scene(name, {"/body_force": [0, gravity], "/time/end": 0.2, "/output/every": 0.1})
        self.expect_tables("light", "heavy", "--out", "gravities")
        ours = [share for _, share in numbers_of("gravities")["light", "misplaced_area", "S"]]
        done = call(ROOT / "tools/compare_interfoam.py", ["--from", "heavy", "light"], WORK)
        theirs = [float(word) for word in done.stdout.splitlines()[1].split()[1:]]
        self.assertGreater(theirs[1], 0.1)
        np.testing.assert_allclose(ours[1:], theirs, atol=0.0015)  # three digits, and pixels three times as wide

    def test_a_particle_is_spread_like_a_b_spline_that_walls_mirror(self):
        raster, h, area = Raster(np.zeros(2), 0.01, (100, 50), 0.1, (True, False)), 0.1, 2e-4
        for x, y in ((0.5, 0.25), (0.003, 0.25), (0.5, 0.008)):
            fraction = raster.fraction(np.array([[x, y]]), np.array([area]))
            self.assertAlmostEqual(fraction.sum() * raster.pixel**2, area, 12)
            across = np.abs((raster.centres(0) - x + 0.5) % 1 - 0.5)
            images = (np.abs(raster.centres(1) - y), raster.centres(1) + y)
            exact = np.outer(b_spline(across / h), sum(b_spline(each / h) for each in images)) * area / h**2
            np.testing.assert_allclose(fraction, exact, atol=0.02 * exact.max())  # particles go to pixels first

    def test_pixels_in_bodies_are_found(self):
        raster = Raster(np.zeros(2), 0.01, (100, 50), 0.1, (False, False))
        square = 0.5 * np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) + [0.2, 0]
        hole = 0.2 * np.array([[0, 0], [0, 1], [1, 1], [1, 0]]) + [0.3, 0.1]
        still = {"pivot": np.zeros(2), "position": np.zeros((1, 2)), "rotation": np.eye(2)[None],
                 "angle": np.zeros((1, 1))}
        ring = np.array([[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4]])
        for points, elements, area in ((square, ring[:4], 0.25), (np.vstack([square, hole]), ring, 0.21),
                                       (hole, ring[:4], 0.46)):
            inside = inside_of(Body("body", points, elements, **still), 0, raster)
            self.assertAlmostEqual(inside.sum() * raster.pixel**2, area, delta=0.005)

    def test_three_grids_give_order_extrapolated_value_and_index(self):
        for name, h in (("coarse", 4), ("middle", 2), ("fine", 1)):
            folder = copy_of(name, f"grid_{name}")
            set_column(folder, "max_speed", lambda t, v, h=h: 1 + 0.01 * h**2)
            set_column(folder, "overlap", lambda t, v, h=h: (-1) ** h + 2 * (h == 2))
        out = self.expect_tables("grid_coarse", "grid_middle", "grid_fine", "--out", "orders", "--columns",
                                 "max_speed,overlap")
        self.assertRegex(out, r"\nmax_speed +at the end +1\.16 +1\.04 +1\.01 +2\.00 +1 +1\.24 %\n")
        self.assertIn("each 2 times as fine", out)
        self.assertIn("overlap at the end: not monotone: an order means nothing", out)
        found = numbers_of("orders")
        self.assertAlmostEqual(found["", "max_speed", "maximum, order"][0][1], 2, 9)
        self.assertAlmostEqual(found["", "max_speed", "maximum, extrapolated"][0][1], 1, 9)
        index = 1.25 * 0.03 / 1.01 / 3
        self.assertAlmostEqual(found["", "max_speed", "maximum, grid convergence index"][0][1], index, 9)
        self.assertNotIn(("", "overlap", "maximum, order"), found)

    def test_an_order_needs_three_grids_of_one_ratio_that_differ_in_nothing_else(self):
        self.assertIn("Three grids", self.expect_tables("fine", "coarse", "middle", "--columns", "max_speed"))
        for others in (("coarse", "middle"), ("coarse", "middle", "longer_fine"), ("coarse", "coarse", "fine")):
            if "longer_fine" in others:
                run_scene("longer_fine", {"/grid/cells": [32, 32], "/time/end": 0.11})
            self.assertNotIn("Three grids", self.expect_tables(*others, "--columns", "max_speed"))

    def test_the_picture_shows_all_runs(self):
        self.expect_tables("coarse", "middle", "--columns", "max_speed", "--out", "picture", drawn=None)
        picture = imread(WORK / "picture/compare.png")[:, :, :3]
        self.assertGreater(picture.shape[0], 700)
        self.assertLess(abs(picture.shape[1] - 1440), 2)
        for colour in ((0, 0x72, 0xb2), (0xd5, 0x5e, 0)):
            near = np.abs(picture - np.array(colour) / 255).max(axis=2) < 0.1
            self.assertGreater(near.sum(), 300, colour)

    def test_runs_without_common_frames_are_compared_by_their_histories(self):
        (copy_of("coarse", "frameless") / "fields.h5").unlink()
        out = self.expect_tables("frameless", "middle", "--columns", "max_speed")
        self.assertIn("No misplaced area: frameless has no frames.", out)
        out = self.expect_tables("minimal", "middle", "--columns", "max_speed")
        self.assertIn("No misplaced area: minimal: fields.h5 has no mass; expected: a run with \"mass\"", out)

    def test_what_cannot_be_compared_is_told(self):
        self.expect_error("nowhere: no results of minamo here", "coarse", "nowhere")
        self.expect_error("expected two runs or more", "coarse")
        self.expect_error("stopped: stopped at ", "stopped", "coarse")
        self.expect_error("`minamo run SCENE --resume` goes on with it", "coarse", "stopped")
        (copy_of("coarse", "killed") / "summary.json").unlink()
        self.expect_error("killed: not finished; expected: a finished run", "killed", "coarse")
        scene = copy_of("coarse", "space") / "scene.json"
        scene.write_text(json.dumps(json.loads(scene.read_text()) | {"dimension": 3}))
        self.expect_error("space has dimension 3, coarse 2", "space", "coarse")
        self.expect_error("coarse: history.csv has no column \"max_sped\"", "coarse", "middle", "--columns", "max_sped")
        self.expect_error("nearest: max_speed", "coarse", "middle", "--columns", "max_sped")
        self.expect_error("t = 7 s is outside the common time", "coarse", "middle", "--at", "7")
        history = copy_of("coarse", "start") / "history.csv"
        history.write_text("".join(history.read_text().splitlines(keepends=True)[:2]))
        self.expect_error("start: no common time", "middle", "start")
        (copy_of("coarse", "bare") / "history.csv").write_text("step,time\n0,0\n1,0.1\n")
        self.expect_error("no common column of the histories but step, time", "bare", "middle")


if __name__ == "__main__":
    unittest.main()
