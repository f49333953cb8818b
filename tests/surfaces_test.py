"""Surfaces of runs: how tools/figures draws them, and how they are made smooth to be rendered. In the environment:
PROGRAM, WORK."""

import shutil
import sys
import unittest

import numpy as np
from figures_test import ROOT, SHORT, WORK, close_to, figures, panel_of, run_scene

sys.path.insert(0, str(ROOT / "tools"))
from figuring.smoothing import smooth  # noqa: E402
from reporting.runs import Run  # noqa: E402
from reporting.surfaces import Surface, has_surface, surface_of  # noqa: E402

LOW, HIGH = np.zeros(3), np.ones(3)


def ball(radius, rings=40):
    """Points and triangles of a ball about the middle of the box, turned outward."""
    polar = np.pi * np.arange(1, rings) / rings
    around = 2 * np.pi * np.arange(2 * rings) / (2 * rings)
    sine, cosine = np.sin(polar)[:, None], np.cos(polar)[:, None]
    ring = np.stack([sine * np.cos(around), sine * np.sin(around), cosine + 0 * around], axis=2).reshape(-1, 3)
    points = 0.5 + radius * np.concatenate([ring, [[0, 0, 1], [0, 0, -1]]])
    width, last = len(around), len(ring) - len(around)
    triangles = []
    for k in range(width):
        right = (k + 1) % width
        triangles += [(len(ring), k, right), (len(ring) + 1, last + right, last + k)]
        for a in range(0, last, width):
            triangles += [(a + k, a + width + k, a + width + right), (a + k, a + width + right, a + right)]
    return points, np.array(triangles)


def volume_of(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.sum(a * np.cross(b, c)) / 6


def directed(triangles):
    """Edges in the direction in which their triangles run through them, as numbers; and those of the opposite one."""
    edges = np.concatenate([triangles[:, pair] for pair in ([0, 1], [1, 2], [2, 0])]).astype(np.int64)
    count = triangles.max() + 1
    return np.sort(edges[:, 0] * count + edges[:, 1]), np.sort(edges[:, 1] * count + edges[:, 0])


def parts_of(triangles):
    """How many surfaces there are that hang together."""
    part = np.arange(triangles.max() + 1)
    while True:
        lowest = part.copy()
        for k in range(3):
            np.minimum.at(lowest, triangles[:, k], part[triangles].min(axis=1))
        lowest = lowest[lowest]
        if np.array_equal(lowest, part):
            return len(np.unique(part[triangles]))
        part = lowest


def drop(middle):
    """What minamo writes for a particle alone: 12 points and 20 triangles, here of no particular shape."""
    turn = np.arange(20)
    return middle + 0.01 * np.eye(3)[np.arange(12) % 3], np.stack([turn % 12, (turn + 1) % 12, (turn + 2) % 12], axis=1)


class Smoothing(unittest.TestCase):
    def test_what_is_short_goes_and_the_volume_stays(self):
        points, triangles = ball(0.3)
        rough = points + 0.003 * np.random.default_rng(1).standard_normal(points.shape)
        smoothed = smooth(Surface(rough, triangles), LOW, HIGH)
        np.testing.assert_array_equal(smoothed.elements, triangles)
        # Away from the poles, where triangles are slivers.
        middle = np.abs(points[:, 2] - 0.5) < 0.2

        def roughness(x):
            return np.std(np.linalg.norm(x[middle] - 0.5, axis=1))

        self.assertLess(roughness(smoothed.points), 0.35 * roughness(rough))
        self.assertAlmostEqual(volume_of(smoothed.points, triangles) / volume_of(points, triangles), 1, delta=0.005)

    def test_points_on_a_wall_stay_on_it(self):
        points, triangles = ball(0.3)
        cut = np.maximum(points, [0, 0, 0.4])  # a ball that lies on a floor
        smoothed = smooth(Surface(cut, triangles), np.array([0, 0, 0.4]), HIGH).points
        floor = cut[:, 2] == 0.4
        np.testing.assert_array_equal(smoothed[floor, 2], 0.4)
        self.assertGreater(np.abs(smoothed[floor, :2] - cut[floor, :2]).max(), 0)

    def test_drops_of_one_particle_stay_as_they_are(self):
        points, triangles = ball(0.3)
        for count in (0, 1, 3):
            with self.subTest(drops=count):
                parts = [(points, triangles)] + [drop(np.full(3, 0.1 + 0.02 * k)) for k in range(count)]
                first = np.cumsum([0] + [len(part[0]) for part in parts])
                surface = Surface(np.concatenate([part[0] for part in parts]),
                                  np.concatenate([part[1] + at for part, at in zip(parts, first)]))
                smoothed = smooth(surface, LOW, HIGH).points
                np.testing.assert_array_equal(smoothed[len(points):], surface.points[len(points):])
                alone = smooth(Surface(points, triangles), LOW, HIGH).points
                np.testing.assert_array_equal(smoothed[:len(points)], alone)

    def test_drops_alone_and_nothing_are_surfaces_too(self):
        points, triangles = drop(np.full(3, 0.5))
        np.testing.assert_array_equal(smooth(Surface(points, triangles), LOW, HIGH).points, points)
        nothing = Surface(np.empty((0, 3)), np.empty((0, 3), int))
        self.assertEqual(len(smooth(nothing, LOW, HIGH).points), 0)


class Surfaces(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(WORK, ignore_errors=True)
        WORK.mkdir(parents=True)

    def test_the_surface_of_a_run_is_drawn_around_its_particles(self):
        for name in ("vtp", "ply"):
            with self.subTest(format=name):
                self.assertEqual(run_scene("dam_break", name, SHORT | {"/output/surface": name, "/time/end": 0.01}), 0)
                self.assertEqual(figures(name, "--times", "0", "--field", "speed", "--no-movie").returncode, 0)
                panel = panel_of(WORK / name / "figures/speed.png")
                dark = close_to(panel, (0.125, 0.125, 0.125))
                rows, columns = dark.mean(axis=1), dark.mean(axis=0)
                # The column stands in the lower left corner, 1/4 x 1/2 of the box: its upper and its right side.
                tenth, half = len(rows) // 10, len(columns) // 2
                self.assertAlmostEqual((tenth + np.argmax(rows[tenth:-tenth])) / len(rows), 0.5, delta=0.02)
                self.assertAlmostEqual((tenth + np.argmax(columns[tenth:half])) / len(columns), 0.25, delta=0.02)
                broken = WORK / name / "surface" / f"0000.{name}"
                broken.write_bytes(b"v 1\nend_header\n")
                done = figures(name, "--times", "0", "--field", "speed", "--no-movie")
                self.assertEqual(done.returncode, 2)
                self.assertIn(f"0000.{name}: cannot be read", done.stderr)

    def test_what_an_earlier_run_has_left_is_not_drawn(self):
        short = SHORT | {"/time/end": 0.01}
        moved = {"/particles/0/shape": {"box": {"low": [0.3, 0], "high": [0.4, 0.1]}}}
        self.assertEqual(run_scene("dam_break", "earlier", short | moved | {"/output/surface": "vtp"}), 0)
        for name in ("none", "ply"):
            self.assertEqual(run_scene("dam_break", f"later_{name}", short | {"/output/surface": name}), 0)
            shutil.copytree(WORK / "earlier/surface", WORK / f"later_{name}/surface", dirs_exist_ok=True)
        run = Run(WORK / "later_none")
        self.assertFalse(any(has_surface(run, frame) for frame in range(len(run.times))))
        self.assertLess(surface_of(Run(WORK / "later_ply"), 0).points[:, 0].max(), 0.2)  # that of the column at the left

    def test_both_formats_say_the_same_and_enclose_the_liquid(self):
        coarse = {"/grid/cells": [8, 4, 8], "/time/end": 0.02, "/time/step": 0.01, "/output/every": 0.02}
        found = []
        for name in ("vtp", "ply"):
            self.assertEqual(run_scene("dam_break_3d", f"space_{name}", coarse | {"/output/surface": name}), 0)
            found.append(surface_of(Run(WORK / f"space_{name}"), 0))
        np.testing.assert_array_equal(found[0].points, found[1].points)
        np.testing.assert_array_equal(found[0].elements, found[1].elements)
        run = Run(WORK / "space_ply")
        box = run.scene["particles"][0]["shape"]["box"]
        liquid = np.prod(np.subtract(box["high"], box["low"]))
        self.assertAlmostEqual(volume_of(found[0].points, found[0].elements) / liquid, 1, delta=0.01)
        # Smoothing takes the edges of the column along: 3 of its 12, each a rounding of half a particle.
        smoothed = smooth(found[0], *run.box)
        self.assertAlmostEqual(volume_of(smoothed.points, smoothed.elements) / liquid, 1, delta=0.03)

    def test_every_frame_of_a_splash_is_closed_and_has_the_volume_of_the_liquid(self):
        settings = {"/grid/cells": [16, 8, 16], "/time/end": 0.4, "/time/step": 0.004, "/output/every": 0.1}
        self.assertEqual(run_scene("dam_break_3d", "splash", settings | {"/output/surface": "ply"}), 0)
        run = Run(WORK / "splash")
        box = run.scene["particles"][0]["shape"]["box"]
        liquid = np.prod(np.subtract(box["high"], box["low"]))
        self.assertEqual(len(run.times), 5)
        for frame in range(5):
            with self.subTest(frame=frame):
                surface = surface_of(run, frame)
                there, back = directed(surface.elements)
                self.assertEqual(len(np.unique(there)), len(there))  # no edge has two triangles on the same side
                np.testing.assert_array_equal(there, back)  # and each has one on either side
                # Euler's number: 2 for every part, less 2 for every handle.
                number = len(np.unique(surface.elements)) - len(there) // 2 + len(surface.elements)
                self.assertEqual(number % 2, 0)
                self.assertLessEqual(number, 2 * parts_of(surface.elements))
                # 0.4 % measured.
                self.assertAlmostEqual(volume_of(surface.points, surface.elements) / liquid, 1, delta=0.01)

    def test_what_cannot_be_rendered_is_told(self):
        self.assertEqual(run_scene("dam_break", "plane", SHORT | {"/time/end": 0.01}), 0)
        coarse = {"/grid/cells": [8, 4, 8], "/time/end": 0.01, "/time/step": 0.01}
        self.assertEqual(run_scene("dam_break_3d", "space", coarse), 0)
        for folder, message in (("plane", "plane: --render shows runs in 3-D, this one is in 2-D"),
                                ("space", "space/surface: no surface of frame 0; expected: that of a run with "
                                          "\"output\": {\"surface\": \"ply\"}")):
            done = figures(folder, "--render")
            self.assertEqual((done.returncode, done.stderr), (2, message + "\n"))
        self.assertEqual(run_scene("dam_break_3d", "wet", coarse | {"/output/surface": "vtp"}), 0)
        done = figures("wet", "--render", "--times", "7")
        self.assertEqual((done.returncode, done.stderr), (2, "wet: t = 7 s is outside the run; expected: between 0 and 0.01 s; "
                                                           "nearest: 0.01 s\n"))
        done = figures("wet", "--render", path=WORK)
        self.assertEqual((done.returncode, done.stderr),
                         (2, "blender, which renders, is not installed: sudo apt-get install blender\n"))
        done = figures("wet", "--render", "--eye=1,2,3")
        self.assertEqual(done.returncode, 2)
        self.assertIn("argument --eye: expected two angles, the second from -90 to 90 degrees, got \"1,2,3\"",
                      done.stderr)


if __name__ == "__main__":
    unittest.main()
