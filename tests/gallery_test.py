"""scenes/GALLERY.md and the pictures on it. In the environment: PROGRAM, WORK."""

import json
import os
import re
import shutil
import struct
import sys
import unittest
from pathlib import Path
from unittest.mock import patch

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))
from figuring.clipping import clipped  # noqa: E402
from figuring.documents import Pictures, write_pictures  # noqa: E402
from figuring.gallery import GALLERY, LARGEST, Exhibit  # noqa: E402

WORK = Path(os.environ["WORK"])
SCENES = ROOT / "scenes"
PAGE = (SCENES / "GALLERY.md").read_text()
# A box 1 x 2 x 3, its corners by x, then y, then z, and the two triangles of every side.
CORNERS = np.array([[x, y, z] for z in (0, 3) for y in (0, 2) for x in (0, 1)], float)
SIDES = [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4], [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2],
         [1, 3, 7], [1, 7, 5]]


def size_of_png(path):
    """Width and height in pixels."""
    return struct.unpack(">II", path.read_bytes()[16:24])


def volume_of(triangles):
    return np.linalg.det(triangles).sum() / 6


def area_of(triangles):
    """With its direction: zero of a closed surface."""
    return 0.5 * np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]).sum(axis=0)


class Page(unittest.TestCase):
    def setUp(self):
        self.sections = re.split(r"^## ", PAGE, flags=re.MULTILINE)[1:]

    def test_a_section_per_scene_says_how_it_is_run_and_how_long_that_takes(self):
        self.assertEqual(len(self.sections), len(GALLERY))
        for exhibit, section in zip(GALLERY, self.sections):
            with self.subTest(exhibit.name):
                self.assertIn(f"](gallery/{exhibit.name}.png)", section)
                self.assertIn(f"]({exhibit.scene}.json)", section)
                self.assertIn(f"\n    {exhibit.command}\n", section)
                self.assertRegex(section, r"\d s on two cores")

    def test_every_scene_is_there_and_has_frames_at_the_times_that_are_shown(self):
        for exhibit in GALLERY:
            with self.subTest(exhibit.name):
                scene = json.loads((SCENES / f"{exhibit.scene}.json").read_text())
                every, end = scene["output"]["every"], dict(exhibit.settings).get("/time/end", scene["time"]["end"])
                for time in exhibit.times:
                    self.assertAlmostEqual(time / every, round(time / every), places=6)
                    self.assertLessEqual(time, end)

    def test_every_picture_is_there_and_small_and_there_are_no_others(self):
        pictures = {path.name for path in (SCENES / "gallery").iterdir()}
        self.assertEqual(pictures, {f"{exhibit.name}.png" for exhibit in GALLERY})
        for name in pictures:
            with self.subTest(name):
                self.assertLessEqual((SCENES / "gallery" / name).stat().st_size, LARGEST)
                self.assertTrue(800 <= size_of_png(SCENES / "gallery" / name)[0] <= 1000)

    def test_the_scenes_lead_to_the_page(self):
        self.assertIn("](GALLERY.md)", (SCENES / "README.md").read_text().partition("\n## ")[0])


class Drawing(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(WORK, ignore_errors=True)
        (WORK / "pictures").mkdir(parents=True)

    def draw(self, **settings):
        """Draws a scene with constants in its places; the picture, and when the run was made."""
        coarse = (("/grid/cells", [60, 4]), ("/time/step", 0.02), ("/time/end", settings.get("end", 0.1)))
        exhibit = Exhibit("hydraulic_jump", (0.0, 0.1), part=((1.0, 0.0), (3.0, 0.3)), settings=coarse)
        with patch.dict(os.environ, {"MINAMO": os.environ["PROGRAM"]}):
            [picture] = write_pictures(Pictures("", SCENES, (exhibit,)), SCENES, WORK / "runs", WORK / "pictures")
        return picture, (WORK / "runs/hydraulic_jump/summary.json").stat().st_mtime_ns

    def test_a_scene_is_run_once_and_anew_when_its_settings_change(self):
        picture, first = self.draw()
        self.assertEqual(size_of_png(picture)[0], 900)
        self.assertLess(picture.stat().st_size, LARGEST)
        self.assertEqual(self.draw()[1], first)
        self.assertNotEqual(self.draw(end=0.12)[1], first)

    def test_bodies_end_at_the_sides_of_the_box_and_are_closed_there(self):
        whole = CORNERS[SIDES]
        self.assertEqual(clipped(whole, np.full(3, -1.0), np.full(3, 4.0)).tolist(), whole.tolist())
        for low, high in (((-1, 0.5, -1), (4, 4, 4)), ((0.25, 0.5, 1), (0.75, 4, 2)), ((0.5, -1, -1), (4, 1.5, 2.5))):
            with self.subTest((low, high)):
                low, high = np.array(low, float), np.array(high, float)
                part = clipped(whole, low, high)
                inside = np.minimum(high, [1, 2, 3]) - np.maximum(low, 0)
                self.assertAlmostEqual(volume_of(part), np.prod(inside))
                np.testing.assert_allclose(area_of(part), 0, atol=1e-9)
                self.assertTrue(np.all(part > low - 1e-9) and np.all(part < high + 1e-9))

    def test_the_end_of_a_pipe_that_goes_through_a_side_has_a_hole(self):
        hole = (CORNERS * [0.5, 0.5, 2] + [0.25, 0.5, -1])[SIDES][:, ::-1]  # goes through both ends
        self.assertAlmostEqual(volume_of(hole), -3)
        tube = clipped(np.concatenate([CORNERS[SIDES] * [1, 1, 2] - [0, 0, 1], hole]), np.array([-9, -9, 0.0]),
                       np.array([9, 9, 2.0]))
        self.assertAlmostEqual(volume_of(tube), 2 * (2 - 0.5))

    def test_nothing_is_left_of_what_is_outside(self):
        self.assertEqual(len(clipped(CORNERS[SIDES], np.full(3, 5.0), np.full(3, 6.0))), 0)


if __name__ == "__main__":
    unittest.main()
