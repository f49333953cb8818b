"""Level sets of surfaces as OpenVDB reads them, and the meshes of the same run. In the environment: PROGRAM, WORK."""

import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

import numpy as np
import pyopenvdb

ROOT = Path(__file__).resolve().parent.parent
WORK = Path(os.environ["WORK"])
sys.path.insert(0, str(ROOT / "tools"))
from reporting.runs import Run  # noqa: E402
from reporting.surfaces import surface_of  # noqa: E402

SPACING = 0.584 / 16 / 2  # of the particles [m]


def run(name, surface, threads=1):
    folder = WORK / name
    shutil.rmtree(folder, ignore_errors=True)
    command = [os.environ["PROGRAM"], "run", str(ROOT / "scenes/dam_break_3d.json"), "--quiet", "--out", str(folder),
               "--threads", str(threads)]
    for pointer, value in (("/grid/cells", "[16, 8, 16]"), ("/particles/0/per_cell", "2"), ("/time/end", "0.2"),
                           ("/output/every", "0.1"), ("/output/surface", f'"{surface}"')):
        command += ["--set", f"{pointer}={value}"]
    subprocess.run(command, check=True, timeout=60)
    return folder


def active(grid):
    """Values of the active voxels, by place."""
    return {item.min: item.value for item in grid.iterOnValues() if item.count == 1}


class LevelSets(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = run("one", "vdb")
        cls.mesh = surface_of(Run(run("mesh", "ply")), 2)
        cls.distance, cls.velocity = (pyopenvdb.read(str(cls.folder / "surface/0002.vdb"), name)
                                      for name in ("surface", "velocity"))

    def test_there_is_one_for_every_frame(self):
        self.assertEqual(sorted(path.name for path in (self.folder / "surface").iterdir()),
                         [f"000{k}.vdb" for k in range(3)])
        self.assertEqual(self.distance.gridClass, pyopenvdb.GridClass.LEVEL_SET)
        self.assertAlmostEqual(self.distance.transform.voxelSize()[0], SPACING, delta=1e-6)

    def test_it_is_zero_on_the_mesh(self):
        read = self.distance.getConstAccessor()
        there = np.rint(self.mesh.points / SPACING).astype(int)
        values = np.array([read.getValue(tuple(int(k) for k in at)) for at in there])
        self.assertLess(np.abs(values).max(), np.sqrt(3) / 2 * SPACING * 1.001)  # of the voxel that is nearest

    def test_it_holds_the_volume_of_the_mesh(self):
        a, b, c = (self.mesh.points[self.mesh.elements[:, k]] for k in range(3))
        volume = np.sum(a * np.cross(b, c)) / 6
        low, high = self.distance.evalActiveVoxelBoundingBox()
        values = np.empty([y - x + 1 for x, y in zip(low, high)], np.float32)
        self.distance.copyToArray(values, ijk=low)
        filled = np.clip(0.5 - values / SPACING, 0, 1).sum() * SPACING**3
        self.assertAlmostEqual(filled / volume, 1, delta=0.05)  # 0.026: edges of this coarse column are a voxel wide

    def test_every_voxel_of_the_band_has_a_velocity(self):
        self.assertEqual(self.velocity.activeVoxelCount(), self.distance.activeVoxelCount())
        speeds = np.linalg.norm(list(active(self.velocity).values()), axis=1)
        self.assertTrue(np.isfinite(speeds).all())
        self.assertGreater(speeds.max(), 0.5)
        self.assertLess(speeds.max(), 5)

    def test_two_threads_give_the_same(self):
        folder = run("two", "vdb", threads=2)
        for name, grid in (("surface", self.distance), ("velocity", self.velocity)):
            again = pyopenvdb.read(str(folder / "surface/0002.vdb"), name)
            self.assertEqual(active(again), active(grid))


if __name__ == "__main__":
    WORK.mkdir(parents=True, exist_ok=True)
    unittest.main()
