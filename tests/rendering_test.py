"""What Blender makes of surfaces. In the environment: PROGRAM, WORK."""

import shutil
import subprocess
import sys
import unittest

from figures_test import ROOT, WORK, figures, run_scene, size_of_png
from matplotlib.image import imread

sys.path.insert(0, str(ROOT / "tools"))
from reporting.runs import Run  # noqa: E402
from reporting.surfaces import surface_of  # noqa: E402

SKIPPED = 77  # what ctest takes for a skipped test
COARSE = {"/grid/cells": [16, 8, 16], "/particles/0/per_cell": 2, "/time/end": 0.02, "/time/step": 0.01,
          "/output/every": 0.01}
BALL = {"name": "ball", "shape": {"ball": {"center": [0.3, 0.15, 0.1], "radius": 0.08}}}
SMALL = ("--size", "96x64", "--samples", "4")


# Blender's own importer, and what it finds of the mesh: vertices, edges without two faces, volume.
LOOK = """
import bmesh, bpy, sys
bpy.ops.import_mesh.ply(filepath=sys.argv[-1])
mesh = bmesh.new()
mesh.from_mesh(bpy.context.object.data)
loose = sum(not edge.is_manifold for edge in mesh.edges)
print("found", len(mesh.verts), loose, mesh.calc_volume(signed=True))
"""


class Rendering(unittest.TestCase):
    def test_blender_opens_a_surface_and_finds_it_closed(self):
        self.assertEqual(run_scene("dam_break_3d", "opened", COARSE | {"/output/surface": "ply"}), 0)
        file = WORK / "opened/surface/0002.ply"
        done = subprocess.run(["blender", "--background", "--factory-startup", "--python-expr", LOOK, "--", str(file)],
                              capture_output=True, text=True, check=True)
        vertices, loose, volume = done.stdout.partition("found ")[2].split()[:3]
        surface = surface_of(Run(WORK / "opened"), 2)
        self.assertEqual(int(vertices), len(surface.points))
        self.assertEqual(int(loose), 0)
        # Blender's numbers have 7 digits, and its volume is a sum over all triangles.
        self.assertAlmostEqual(float(volume) / (0.146 * 0.146 * 0.292), 1, delta=0.01)

    def test_water_and_bodies_are_rendered(self):
        for name in ("ply", "vtp"):
            with self.subTest(format=name):
                settings = COARSE | {"/output/surface": name, "/bodies": [BALL]}
                self.assertEqual(run_scene("dam_break_3d", name, settings), 0)
                done = figures(name, "--render", "--times", "0,0.02", *SMALL)
                pictures = [WORK / name / f"figures/render_{frame}.png" for frame in ("0000", "0002")]
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                self.assertEqual(done.stdout.split(), [str(picture) for picture in pictures])
                for picture in pictures:
                    self.assertEqual(size_of_png(picture), (96, 64))
                    colours = imread(picture)[:, :, :3]
                    self.assertGreater((colours[:, :, 2] - colours[:, :, 0] > 0.3).mean(), 0.02)  # water
                    self.assertGreater((colours[:, :, 0] - colours[:, :, 2] > 0.15).mean(), 0.003)  # the ball

    def test_the_eye_sees_the_column_at_the_left_and_from_behind_at_the_right(self):
        self.assertEqual(run_scene("dam_break_3d", "seen", COARSE | {"/output/surface": "ply", "/time/end": 0.01}), 0)
        middles = []
        for eye in ("0,10", "180,10"):
            self.assertEqual(figures("seen", "--render", "--times", "0", f"--eye={eye}", *SMALL).returncode, 0)
            colours = imread(WORK / "seen/figures/render_0000.png")[:, :, :3]
            middles.append((colours[:, :, 2] - colours[:, :, 0] > 0.3).nonzero()[1].mean())
        self.assertLess(middles[0], 40)
        self.assertGreater(middles[1], 56)


if __name__ == "__main__":
    if not shutil.which("blender"):
        print("skipped: blender is not installed (sudo apt-get install blender)")
        sys.exit(SKIPPED)
    shutil.rmtree(WORK, ignore_errors=True)
    unittest.main()
