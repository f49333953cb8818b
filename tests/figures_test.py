"""What tools/figures makes of small runs, and what it says of wrong input. In the environment: PROGRAM, WORK."""

import json
import os
import shutil
import struct
import subprocess
import sys
import unittest
from pathlib import Path
from unittest.mock import patch

import h5py
import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.image import imread

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "tests/support"), str(ROOT / "tools")]
import figuring.__main__  # noqa: E402, F401  for call()
from figuring.layout import png  # noqa: E402
from figuring.plots import draw_history  # noqa: E402
from forked import call  # noqa: E402
from reporting.runs import Run  # noqa: E402

PROGRAM = os.environ["PROGRAM"]
WORK = Path(os.environ["WORK"])
SHORT = {"/time/end": 0.1, "/time/step": 0.005, "/output/every": 0.01}
# Calls that draw pictures of the documents; the scenes that they run, and the picture that each is in.
PICTURES = {
    "paper": {"paper/dam_break_pic": "dam_break.png", "paper/dam_break_flip": "dam_break.png",
              "paper/dam_break_tpic": "dam_break.png", "paper/rotating_square_flip": "rotating_square.png",
              "paper/rotating_square_tpic": "rotating_square.png"},
    "readme": {"dam_break": "dam_break.png"},
    "results": {"tilted_pool": "rest.png", "tilted_tank": "rest.png", "obstacle": "obstacle.png"},
}
COARSE = {"/grid/cells": [16, 8, 16], "/particles/0/per_cell": 2, "/time/end": 0.06, "/time/step": 0.01}


def run_scene(scene, folder, settings):
    """Runs a scene into WORK/folder; the exit status."""
    command = [PROGRAM, "run", str(ROOT / f"scenes/{scene}.json"), "--out", str(WORK / folder)]
    command += ["--threads", "1", "--quiet"]
    for key, value in settings.items():
        command += ["--set", f"{key}={json.dumps(value)}"]
    return subprocess.run(command, stderr=subprocess.DEVNULL, check=False).returncode


def figures(*arguments, path=None):
    """Calls the python part of tools/figures in WORK; `path`: where it finds programs."""
    environment = os.environ | {"PYTHONPATH": str(ROOT / "tools"), "MINAMO": PROGRAM}
    if path is not None:
        environment["PATH"] = str(path)
    return call("figuring", list(map(str, arguments)), WORK, environment)


def strips(*arguments):
    """The same without movies and without the plots, which take half of the time: for who looks at panels alone."""
    with patch("figuring.plots.draw_history", return_value=None), patch("figuring.plots.draw_systems", return_value=None):
        return figures(*arguments, "--no-movie")


def size_of_png(path):
    """Width and height in pixels."""
    start = path.read_bytes()[:24]
    assert start[:8] == b"\x89PNG\r\n\x1a\n", f"{path} is no PNG"
    return struct.unpack(">II", start[16:])


def stream_of(movie):
    """What ffprobe says of a video after it has decoded all of it."""
    command = ["ffprobe", "-v", "error", "-count_frames", "-of", "json", "-show_entries",
               "stream=nb_read_frames,width,height,codec_name,pix_fmt", str(movie)]
    return json.loads(subprocess.run(command, capture_output=True, check=True).stdout)["streams"][0]


def frames_of(folder):
    with h5py.File(WORK / folder / "fields.h5") as file:
        return len(file["particles"])


def panel_of(path):
    """The pixels inside the walls of a strip with one panel: rows from the top, colours from 0 to 1."""
    picture = imread(path)[:, :, :3]
    dark = picture.max(axis=2) < 0.25
    rows, columns = (np.flatnonzero(count > 0.8 * count.max()) for count in (dark.sum(axis=1), dark.sum(axis=0)))
    return picture[rows[0]:rows[-1], columns[0]:columns[-1]]


def close_to(picture, colour, distance=0.1):
    return np.abs(picture - np.array(colour)).max(axis=2) < distance


class Figures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(WORK, ignore_errors=True)
        WORK.mkdir(parents=True)
        for scene in ("dam_break_tpic", "dam_break_flip"):
            assert run_scene(f"paper/{scene}", scene, SHORT) == 0
        assert run_scene("dam_break_3d", "space", COARSE) == 0
        png(draw_history([Run(WORK / "dam_break_tpic")]))  # fonts and signs are read once, here, not in every call

    def expect_files(self, done, *paths):
        self.assertEqual(done.stderr, "")
        self.assertEqual(done.stdout.split(), list(paths))
        self.assertEqual(done.returncode, 0)

    def expect_error(self, message, *arguments):
        done = figures(*arguments)
        self.assertEqual(done.stderr.strip(), message)
        self.assertEqual((done.returncode, done.stdout), (2, ""))

    def test_a_run_gives_strips_histories_and_a_movie_with_all_its_frames(self):
        names = ("speed.png", "pressure.png", "history.png", "systems.png", "speed.mp4")
        self.expect_files(figures("dam_break_tpic"), *(f"dam_break_tpic/figures/{name}" for name in names))
        for name in names[:3]:
            width, height = size_of_png(WORK / "dam_break_tpic/figures" / name)
            self.assertEqual(width, 1440)  # 7.2 inches with 200 dots each
            self.assertGreater(height, 500)
        movie = stream_of(WORK / "dam_break_tpic/figures/speed.mp4")
        self.assertEqual(frames_of("dam_break_tpic"), 11)
        self.assertEqual(int(movie["nb_read_frames"]), 11)
        self.assertEqual((movie["codec_name"], movie["pix_fmt"]), ("h264", "yuv420p"))  # what every player shows

    def test_particles_are_drawn_where_they_are(self):
        done = strips("dam_break_tpic", "--times", "0", "--field", "pressure", "--out", "start")
        self.expect_files(done, "start/pressure.png")
        panel = panel_of(WORK / "start/pressure.png")
        where = np.argwhere(np.ptp(panel, axis=2) > 0.1)
        # The column takes a quarter of the width and half of the height of the tank; particles and walls have a width.
        self.assertAlmostEqual(where[:, 1].max() / panel.shape[1], 0.25, delta=0.015)
        self.assertAlmostEqual(1 - where[:, 0].min() / panel.shape[0], 0.5, delta=0.015)

    def test_runs_stand_side_by_side_with_the_lines_of_a_reference(self):
        call = ("dam_break_tpic", "dam_break_flip", "--times", "0.1", "--field", "speed")
        red = (0.84, 0.15, 0.16)
        reference = ROOT / "scenes/reference/dam_break_interfoam"
        self.assertEqual(strips(*call, "--out", "bare").stderr, "")
        self.assertEqual(figures(*call, "--out", "both", "--reference", reference).stderr, "")
        self.assertFalse(close_to(imread(WORK / "bare/speed.png")[:, :, :3], red).any())
        self.assertGreater(close_to(imread(WORK / "both/speed.png")[:, :, :3], red).sum(), 200)
        self.assertEqual(int(stream_of(WORK / "both/speed.mp4")["nb_read_frames"]), 11)
        width, height = size_of_png(WORK / "both/speed.png")
        self.assertGreater(height, 1.5 * width)  # a column with a panel per run

    def test_a_run_in_space_is_seen_as_a_whole_and_as_a_slice(self):
        self.expect_files(figures("space", "--field", "speed"), "space/figures/speed.png", "space/figures/history.png",
                          "space/figures/systems.png", "space/figures/speed.mp4")
        self.assertEqual(int(stream_of(WORK / "space/figures/speed.mp4")["nb_read_frames"]), frames_of("space"))
        done = figures("space", "--field", "pressure", "--slice", "x=0.1", "--times", "0.06")
        self.assertEqual(done.stderr, "")
        self.assertEqual(int(stream_of(WORK / "space/figures/pressure_x0.1.mp4")["nb_read_frames"]), frames_of("space"))
        panel = panel_of(WORK / "space/figures/pressure_x0.1.png")
        self.assertAlmostEqual(panel.shape[0] / panel.shape[1], 2, delta=0.02)  # y and z of the tank
        self.assertGreater((np.ptp(panel, axis=2) > 0.1).mean(), 0.1)

    def test_bodies_are_filled_where_they_are_in_strips_slices_and_movies(self):
        settings = {"/grid/cells": [20, 20], "/time/end": 0.2, "/time/step": 0.01, "/output/every": 0.1}
        assert run_scene("mixer", "mixer", settings) == 0
        self.assertEqual(figures("mixer", "--times", "0", "--field", "speed").stderr, "")
        panel = panel_of(WORK / "mixer/figures/speed.png")[5:-5, 5:-5]
        rows, columns = np.nonzero(close_to(panel, (0.725, 0.745, 0.769), 0.01))
        # The arms of the cross reach over 0.6 of the tank, which is square; the colour bar is as long as a wall.
        self.assertAlmostEqual(np.ptp(columns) / panel.shape[0], 0.6, delta=0.02)
        self.assertAlmostEqual(rows.min() / panel.shape[0], 0.2, delta=0.02)
        self.assertEqual(int(stream_of(WORK / "mixer/figures/speed.mp4")["nb_read_frames"]), 3)
        ball = {"name": "ball", "shape": {"ball": {"center": [0.4, 0.05, 0.1], "radius": 0.04}}}
        assert run_scene("dam_break_3d", "ball", COARSE | {"/bodies": [ball]}) == 0
        for more in ([], ["--slice", "y=0.05"]):
            self.assertEqual(strips("ball", "--times", "0", "--field", "speed", *more).stderr, "")
        panel = panel_of(WORK / "ball/figures/speed_y0.05.png")[5:-5, 5:-5]
        share = close_to(panel, (0.725, 0.745, 0.769), 0.01).sum() / panel.shape[0]**2
        self.assertAlmostEqual(share, np.pi * 0.04**2 / 0.584**2, delta=0.1 * share)  # its line takes 5 %

    def test_several_liquids_are_told_apart_first_of_all(self):
        settings = {"/grid/cells": [48, 8], "/time/end": 0.04, "/output/every": 0.02}
        self.assertEqual(run_scene("lock_exchange", "lock", settings), 0)
        done = figures("lock", "--times", "0", "--no-movie")
        self.expect_files(done, *(f"lock/figures/{name}.png" for name in ("fluid", "speed", "pressure", "history",
                                                                          "systems")))
        panel = panel_of(WORK / "lock/figures/fluid.png")
        left, right = np.split(panel, [panel.shape[1] // 2], axis=1)
        # Names are counted in alphabetical order: fresh water on the right, salt water on the left.
        for half, own, other in ((right, "#0072b2", "#d55e00"), (left, "#d55e00", "#0072b2")):
            self.assertGreater(close_to(half, to_rgb(own)).mean(), 0.5)
            self.assertLess(close_to(half, to_rgb(other)).mean(), 0.1)

    def test_every_frame_is_drawn_where_openings_change_the_number_of_particles(self):
        self.assertEqual(run_scene("tap", "tap", {"/grid/cells": [48, 32], "/time/end": 0.3}), 0)
        with h5py.File(WORK / "tap/fields.h5") as file:
            self.assertGreater(len({len(frame["id"]) for frame in file["particles"].values()}), 5)
        names = ("speed.png", "history.png", "systems.png", "speed.mp4")
        self.expect_files(figures("tap", "--field", "speed"), *(f"tap/figures/{name}" for name in names))
        self.assertEqual(int(stream_of(WORK / "tap/figures/speed.mp4")["nb_read_frames"]), frames_of("tap"))
        # The jet, which comes in from above, between 1/6 and 5/24 of the width, is there at the end and not before.
        for time, expected in (("0", False), ("0.3", True)):
            self.assertEqual(strips("tap", "--times", time, "--field", "speed").stderr, "")
            panel = panel_of(WORK / "tap/figures/speed.png")
            height, width = panel.shape[:2]
            jet = panel[height // 10:height // 2, width // 6:5 * width // 24]
            self.assertEqual((np.ptp(jet, axis=2) > 0.1).any(), expected)

    def test_frames_without_particles_are_drawn_empty(self):
        dry = {"/particles/0/shape": {"box": {"low": [0.25, 0.25], "high": [0.5, 0.5]}},
               "/particles/0/velocity": ["u", "0"], "/output/every": 0.4,
               "/openings": [{"name": "right", "side": "x_high", "outflow": "free"}]}
        self.assertEqual(run_scene("uniform_stream", "dry", dry), 0)
        self.assertEqual(figures("dry", "--field", "speed").stderr, "")
        self.assertEqual(strips("dry", "--field", "speed", "--times", "2").stderr, "")
        panel = panel_of(WORK / "dry/figures/speed.png")
        left = panel[:, :panel.shape[1] // 2]  # next to a square panel the colour bar is as long as a wall
        self.assertFalse((np.ptp(left, axis=2) > 0.1).any())

    def test_a_slice_shows_nothing_where_there_is_no_liquid(self):
        self.assertEqual(strips("space", "--slice", "x=0.5", "--times", "0", "--out", "dry").stderr, "")
        self.assertFalse((np.ptp(panel_of(WORK / "dry/speed_x0.5.png"), axis=2) > 0.1).any())

    def test_a_run_that_failed_gives_figures_of_what_is_there(self):
        # The force leaves the range of numbers after 0.032 s.
        status = run_scene("paper/dam_break_tpic", "failed", SHORT | {"/body_force": [0, "-9.81/(t < 0.032)"]})
        self.assertEqual(status, 3)
        names = ("speed.png", "history.png", "systems.png", "speed.mp4")
        self.expect_files(figures("failed", "--field", "speed"), *(f"failed/figures/{name}" for name in names))
        self.assertEqual(int(stream_of(WORK / "failed/figures/speed.mp4")["nb_read_frames"]), frames_of("failed"))
        # Next to a run that went on its panels say that it ended.
        done = figures("dam_break_tpic", "failed", "--times", "0,0.1", "--no-movie", "--out", "beside")
        self.assertEqual(done.stderr, "")

    def test_values_beyond_all_numbers_are_magenta_and_do_not_hide_the_others(self):
        shutil.copytree(WORK / "dam_break_tpic", WORK / "diverged")
        with h5py.File(WORK / "diverged/fields.h5", "r+") as file:
            file["particles/10/velocity"][0] = np.inf
            file["particles/10/velocity"][1] = np.nan
            file["particles/10/velocity"][2] = 1e200  # its square is beyond
        done = strips("diverged", "--field", "speed,velocity_x", "--times", "0.1")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        panel = panel_of(WORK / "diverged/figures/speed.png")
        self.assertGreater(close_to(panel, (1, 0, 1)).sum(), 50)
        self.assertGreater((np.ptp(panel, axis=2) > 0.1).mean(), 0.1)  # of the tank, an eighth of which is water

    def test_wrong_input_gives_one_clear_error(self):
        self.expect_error("nowhere: no results of minamo here (no scene.json); "
                          "expected: a folder that `minamo run SCENE --out DIR` wrote", "nowhere")
        empty = WORK / "empty"
        empty.mkdir()
        shutil.copy(WORK / "dam_break_tpic/scene.json", empty)
        self.expect_error("empty: no frames to draw; expected: at least one in fields.h5", "empty")
        cut = WORK / "cut"
        shutil.copytree(WORK / "dam_break_tpic", cut)
        whole = (cut / "fields.h5").read_bytes()
        for size in (0, 100, len(whole) // 2, len(whole) - 1):
            (cut / "fields.h5").write_bytes(whole[:size])
            done = figures("cut", "--no-movie")
            self.assertEqual((done.returncode, done.stdout), (2, ""), size)
            self.assertRegex(done.stderr, r"^cut: fields\.h5 cannot be read \(.*\)\n$")
        self.assertEqual(run_scene("paper/dam_break_tpic", "few", SHORT | {"/output/fields": ["pressure"]}), 0)
        self.expect_error("few: fields.h5 has no velocity, which \"speed\" is made of; expected: a run with \"velocity\" in "
                          "/output/fields", "few", "--field", "speed")
        known = ("speed, pressure, velocity_x, velocity_y, vorticity, velocity_gradient_xx, velocity_gradient_xy, "
                 "velocity_gradient_yx, velocity_gradient_yy, id, mass, volume")
        self.expect_error(f"dam_break_tpic: unknown field \"presure\"; expected one of: {known}; nearest: pressure",
                          "dam_break_tpic", "--field", "presure")
        self.expect_error("dam_break_tpic: t = 3 s is outside the run; expected: between 0 and 0.1 s; "
                          "nearest: 0.1 s",
                          "dam_break_tpic", "--times", "0.1,3")
        self.expect_error("dam_break_tpic: no frame at t = 0.056 s; nearest: 0.05 and 0.06 s",
                          "dam_break_tpic", "--times", "0.056")
        self.expect_error("dam_break_tpic: a run in 2-D cannot be cut at z = 0.1 m",
                          "dam_break_tpic", "--slice", "z=0.1")
        self.expect_error("space: the slice y = 0.4 m misses the box; expected: y between 0 and 0.292 m",
                          "space", "--slice", "y=0.4")
        done = figures("space", "--slice", "w=0.4")
        self.assertEqual(done.returncode, 2)
        self.assertIn("argument --slice: expected an axis and a place on it, like z=0.1, got \"w=0.4\"", done.stderr)

    def test_the_pictures_of_the_documents_come_from_one_call_which_runs_what_is_missing(self):
        for call, names in PICTURES.items():
            with self.subTest(call=call):
                self.draw_documents(call, names)

    def draw_documents(self, call, names):
        scenes, results, out = (WORK / f"{call}_{folder}" for folder in ("scenes", "results", "pictures"))
        scenes.mkdir()
        for name in names:
            scene = json.loads((ROOT / f"scenes/{name}.json").read_text())
            cells = 40 if "rotating" in name else 16
            scene["grid"]["cells"], scene["time"]["step"] = [cells, cells], 0.05  # frames at all times that are shown
            last = scenes / f"{Path(name).name}.json"
            last.write_text(json.dumps(scene))
        command = (call, "--scenes", scenes, "--results", results, "--out", out)
        self.assertEqual(figures(*command).returncode, 0)
        for picture in set(names.values()):
            self.assertAlmostEqual(size_of_png(out / picture)[0], 1440, delta=1)
        written = {path: path.stat().st_mtime_ns for path in results.glob("*/summary.json")}
        with_each_quadrature = [name for name, picture in names.items() if picture == "rest.png"]
        self.assertEqual(len(written), len(names) + len(with_each_quadrature))
        scene["time"]["step"] = 0.025
        last.write_text(json.dumps(scene))
        with patch("figuring.documents.draw_strip"), patch("figuring.documents.draw_frontier"), \
                patch("figuring.documents.draw_rest"), \
                patch("figuring.documents.png", return_value=b""):  # what is run again is asked for, not how it looks
            self.assertEqual(figures(*command).returncode, 0)
        again = [path.parent.name for path, time in written.items() if path.stat().st_mtime_ns != time]
        self.assertEqual(again, [last.stem])


if __name__ == "__main__":
    unittest.main()
