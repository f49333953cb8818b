"""What tools/report decides before any page is there: what is packed how, what fits a scene, what is drawn."""

from __future__ import annotations

import base64
import contextlib
import json
import os
import shutil
import subprocess
import time
import unittest
import zlib
from io import BytesIO
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from results import RESULTS

from reporting.bodies import chained, section
from reporting.facts import liquids
from reporting.graph import draw_graph
from reporting.histories import MOST_ROWS, packed_history, plots
from reporting.overlays import corner_paths, fits, references
from reporting.packing import pack_frames
from reporting.particles import Particles, Quantity
from reporting.rows import Rows, stays_of
from reporting.runs import NoResults, Run, telling_times
from reporting.shading import coarsened, shaded, surface_section
from reporting.surfaces import Surface, loops_of, packed_surfaces


# A box of liquid that leaves through the right side; the last frames are empty.
DRY = ('/particles/0/shape={"box": {"low": [0.25, 0.25], "high": [0.5, 0.5]}}', '/particles/0/velocity=["u", "0"]',
       '/openings=[{"name": "right", "side": "x_high", "outflow": "free"}]')


def unpacked(text: str, frames: int, order: int) -> np.ndarray:
    """Codes by frame, by other means than those of the page."""
    planes = np.frombuffer(zlib.decompress(base64.b64decode(text)), np.uint8).astype(np.int64).reshape(2, frames, -1)
    folded = planes[0] + 256 * planes[1]
    codes = np.where(folded % 2, -(folded + 1) // 2, folded // 2)
    for _ in range(order):
        codes = np.cumsum(codes, axis=0)
    return codes % 65536


class Liquids(unittest.TestCase):
    """reporting.facts."""

    def test_a_liquid_is_told_by_its_viscosity_or_its_law_and_several_by_their_names(self) -> None:
        water = {"density": 1000, "viscosity": 1e-3}
        paste = {"density": 1500, "rheology": {"bingham": {"yield_stress": 5, "viscosity": 1}, "iterations": 10}}
        self.assertEqual("1000 kg/m³, 0.001 Pa s", liquids({"fluid": water}))
        self.assertEqual("1500 kg/m³, bingham", liquids({"fluid": paste}))
        self.assertEqual("water: 1000 kg/m³, 0.001 Pa s; paste: 1500 kg/m³, bingham",
                         liquids({"fluids": {"water": water, "paste": paste}}))


class Packing(unittest.TestCase):
    """reporting.packing."""

    def test_a_number_comes_back_to_half_a_step(self) -> None:
        values = np.random.default_rng(7).uniform(-3, 5, (9, 50))
        for bits, order in ((16, 2), (10, 1), (16, 0)):
            with self.subTest(bits=bits, order=order):
                packed = pack_frames(values, -3, 5, bits, order)
                back = -3 + unpacked(packed.text, 9, order) * packed.step
                self.assertLessEqual(abs(back - values).max(), 0.5 * packed.step * (1 + 1e-9))

    def test_numbers_outside_the_range_and_those_that_are_none_become_its_ends(self) -> None:
        packed = pack_frames(np.array([[-9.0, 9.0, np.nan, np.inf, -np.inf]]), 0, 1, 8, 0)
        self.assertEqual([[0, 255, 0, 255, 0]], unpacked(packed.text, 1, 0).tolist())

    def test_one_wild_particle_leaves_the_others_their_codes(self) -> None:
        quantity = Quantity("speed", "m/s")
        quantity.add(np.append(np.linspace(0, 1, 1000), 1e9), np.arange(1001))
        described, packed = quantity.packed(16, [np.arange(1001)], 1001)
        self.assertEqual(1e9, described["most"])
        self.assertLess(packed.step, 1e-3)  # 1/1000 of the others' range


class Choice(unittest.TestCase):
    """Which particles are in a page."""

    def test_too_many_particles_are_thinned_and_those_left_are_where_they_were(self) -> None:
        run = Run(RESULTS.run("paper/dam_break_tpic", "thin", "/time/end=0.01", "/output/every=0.005"))
        few, all_of_them = Particles.read(run, 100), Particles.read(run, 10**6)
        self.assertEqual(([800] * 3, 0.125, 100), (few.counts, few.share, few.ids.shape[1]))
        np.testing.assert_array_equal(all_of_them.position[:, few.ids[0]], few.position)
        self.assertEqual(*(next(each.high for each in some.quantities if each.name == "speed")
                           for some in (few, all_of_them)))

    def test_a_long_history_is_thinned_and_says_so(self) -> None:
        run = Run(RESULTS.run("paper/dam_break_tpic", "long", "/time/end=0.01"))
        rows = 2 * MOST_ROWS + 1
        run.history = {name: np.resize(values, rows) for name, values in run.history.items()}
        packed = packed_history(run, plots([run]), lambda text: 0)
        self.assertEqual((3, -(-rows // 3)), (packed["every"], packed["rows"]))


class Columns(unittest.TestCase):
    """What frames hold, in old files and new ones."""

    FINE = ("/time/end=0.004", "/output/every=0.002")

    def test_files_of_either_precision_have_the_same_columns(self) -> None:
        single = Run(RESULTS.run("paper/dam_break_tpic", "single", *self.FINE))
        double = Run(RESULTS.run("paper/dam_break_tpic", "double", *self.FINE, '/output/precision="double"'))
        deflated = Run(RESULTS.run("paper/dam_break_tpic", "deflated", *self.FINE, "/output/compression=4"))
        for name, values in double.columns(2).items():
            of_single = single.columns(2)[name]
            self.assertEqual(values.dtype, of_single.dtype)
            self.assertEqual(values.shape, of_single.shape)
            np.testing.assert_allclose(of_single, values, rtol=1e-7)  # half of 2^-23
            np.testing.assert_array_equal(of_single, deflated.columns(2)[name])
        self.assertEqual((2, 4), (single.columns(2)["velocity"].shape[1], single.columns(2)["velocity_gradient"].shape[1]))

    def test_a_file_with_two_components_and_double_precision_is_read_as_ever(self) -> None:
        new = Run(RESULTS.run("paper/dam_break_tpic", "old", *self.FINE, '/output/precision="double"'))
        columns = [new.columns(frame) for frame in range(3)]
        with h5py.File(new.folder / "fields.h5", "r+") as file:
            for frame, held in enumerate(columns):
                for name, values in held.items():
                    del file[f"particles/{frame}/{name}"]
                    file[f"particles/{frame}/{name}"] = values
        old = Run(new.folder)
        for name, values in old.columns(1).items():
            np.testing.assert_array_equal(columns[1][name], values)

    def test_a_field_that_was_left_out_is_named(self) -> None:
        run = Run(RESULTS.run("paper/dam_break_tpic", "few", *self.FINE, '/output/fields=["pressure"]'))
        self.assertEqual({"id", "position", "pressure"}, set(run.columns(0)))
        with self.assertRaisesRegex(NoResults, 'few: fields.h5 has no velocity; expected: a run with "velocity" in'):
            run.frame(0).velocity

    def test_what_some_frames_have_is_not_offered(self) -> None:
        folder = RESULTS.run("paper/dam_break_tpic", "changed", *self.FINE)
        done = subprocess.run([RESULTS.program, "run", RESULTS.source / "scenes/paper/dam_break_tpic.json", "--out", folder,
                               "--resume", "--quiet", "--set", "/time/end=0.008", "--set", "/output/every=0.002", "--set",
                               '/output/fields="minimal"', "--set", '/output/precision="double"'], check=False)
        self.assertEqual(0, done.returncode)
        run = Run(folder)
        self.assertEqual(5, len(run.times))
        self.assertEqual({"id", "position", "velocity", "pressure"}, set(run.columns(0)))
        self.assertEqual(set(run.columns(0)), set(run.columns(4)))
        self.assertEqual({"speed", "velocity x", "velocity y", "pressure"},
                         {quantity.name for quantity in Particles.read(run, 100).quantities})


class Units(unittest.TestCase):
    """reporting.histories."""

    def test_a_plot_has_the_unit_that_the_run_gives_its_columns(self) -> None:
        run = Run(RESULTS.run("mixer", "units", "/grid/cells=[20,20]", "/time/end=0.02", "/time/step=0.01"))
        self.assertEqual(set(run.history), set(run.units))
        units = {column: plot.unit for plot in plots([run]) for column in plot.columns}
        self.assertEqual(("J/m", "N/m", "N", "rad", "J/m"),
                         tuple(units[column] for column in ("kinetic_energy", "cross_force_x", "cross_torque", "cross_angle",
                                                            "energy_balance")))


class Openings(unittest.TestCase):
    """Particles that come and go."""

    @classmethod
    def setUpClass(cls) -> None:
        # The stream moves by half of the box from frame to frame, then by all of it.
        cls.stream = Run(RESULTS.run("uniform_stream", "stream", "/time/end=4", "/output/every=0.5"))
        cls.torrent = Run(RESULTS.run("uniform_stream", "torrent", "/time/end=12", "/output/every=1.5"))
        cls.dry = Run(RESULTS.run("uniform_stream", "dry", *DRY))

    def test_a_row_is_kept_as_long_as_a_particle_is_there_and_is_empty_for_a_frame_before_the_next_one(self) -> None:
        used = Rows()
        rows = [used.of(np.array(ids)).tolist() for ids in ([0, 1, 2], [1, 2, 3], [2, 3, 4], [], [5, 6])]
        self.assertEqual([[0, 1, 2], [1, 2, 3], [2, 3, 0], [], [0, 1]], rows)
        self.assertEqual(4, used.count)

    def test_stays_tell_who_was_where_and_when(self) -> None:
        ids = np.array([[0, 1], [-1, 1], [7, 1], [7, -1], [-1, 3]])
        stays = np.column_stack(stays_of(ids)).tolist()
        self.assertEqual([[0, 0, 0, 0], [0, 2, 3, 7], [1, 0, 2, 1], [1, 4, 4, 3]], stays)

    def test_every_frame_has_its_own_particles(self) -> None:
        for run in (self.stream, self.dry):
            with self.subTest(run=run.name):
                particles = Particles.read(run, 10**6)
                self.assertTrue(particles.changes)
                self.assertLess(particles.ids.shape[1], 2.5 * max(particles.counts))
                for index, ids in enumerate(particles.ids):
                    there = np.argsort(ids)[np.count_nonzero(ids < 0):]
                    columns = run.columns(index)
                    np.testing.assert_array_equal(columns["id"], ids[there])
                    np.testing.assert_array_equal(columns["position"], particles.position[index, there])
                    self.assertEqual(len(columns["id"]), particles.counts[index])
        self.assertEqual(0, particles.counts[-1])

    def test_those_left_of_too_many_stay_as_long_as_they_are_there(self) -> None:
        few = Particles.read(self.stream, 30)
        shown = [set(ids[ids >= 0]) for ids in few.ids]
        chosen = set.union(*shown)
        for index, ids in enumerate(shown):
            self.assertEqual(ids, chosen & set(self.stream.ids(index)))
            # A tenth of them by chance: within five standard deviations.
            expected = few.share * few.counts[index]
            self.assertLess(abs(len(ids) - expected), 5 * np.sqrt(expected))

    def test_telling_times_of_an_even_stream_are_even(self) -> None:
        for run in (self.stream, self.torrent):
            np.testing.assert_allclose(telling_times(run, 5), np.linspace(0, run.times[-1], 5), rtol=0, atol=1e-9)

    def test_telling_times_of_a_box_that_runs_dry_are_those_before_it_is(self) -> None:
        times = telling_times(self.dry, 4)
        self.assertEqual((0, self.dry.times[-1]), (times[0], times[-1]))
        self.assertGreater(len(self.dry.ids(int(np.argmin(abs(self.dry.times - times[2])) - 1))), 0)


class Fitting(unittest.TestCase):
    """Which reference is drawn over which run, and where corners have exact paths."""

    def scene(self, name: str) -> dict[str, Any]:
        return json.loads((RESULTS.source / f"scenes/{name}.json").read_text())

    def run_of(self, name: str, *settings: str) -> Run:
        folder = f"fitting/{name}{len(settings)}"
        return Run(RESULTS.run(name, folder, "/time/end=0.001", "/time/step=0.001", *settings))

    def test_interfoam_fits_the_dam_breaks_it_was_made_for_and_no_others(self) -> None:
        for name, expected in (("dam_break", True), ("paper/dam_break_pic", True), ("dam_break_large", False),
                               ("hydrostatic", False)):
            with self.subTest(scene=name):
                self.assertEqual(expected, bool(references(self.run_of(name))))
        self.assertFalse(references(self.run_of("dam_break", "/fluid/viscosity=1")))

    def test_walls_are_the_same_however_they_are_written(self) -> None:
        scene = self.scene("dam_break")
        for walls, expected in (("slip", True), ({"x": "slip", "y": ["slip", "slip"]}, True),
                                ({"x": "no_slip"}, False)):
            with self.subTest(walls=walls):
                self.assertEqual(expected, fits({"walls": "slip"}, scene | {"walls": walls}))

    def test_what_was_made_without_bodies_and_openings_does_not_fit_a_scene_with_them(self) -> None:
        scene = {"dimension": 2, "walls": "slip"}
        for key in ("bodies", "openings"):
            with self.subTest(key=key):
                self.assertTrue(fits({"walls": "slip"}, scene | {key: []}))
                self.assertFalse(fits({"walls": "slip"}, scene | {key: [{"name": "step"}]}))

    def test_only_boxes_in_free_flight_have_exact_corners(self) -> None:
        for name, expected in (("paper/rotating_square_tpic", True), ("ballistic_block", True), ("dam_break", False),
                               ("elliptical_drop", False), ("gresho", False), ("drop_3d", False)):
            with self.subTest(scene=name):
                self.assertEqual(expected, corner_paths(self.run_of(name)) is not None)
        opening = '/openings=[{"name": "out", "side": "x_high", "outflow": "free"}]'
        self.assertIsNone(corner_paths(self.run_of("ballistic_block", opening)))


class Sections(unittest.TestCase):
    """reporting.bodies."""

    def test_a_cut_of_a_box_is_a_loop_with_its_area(self) -> None:
        corners = np.array([[x, y, z] for z in (0, 3) for y in (0, 2) for x in (0, 1)], float)
        rows = [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4], [2, 6, 7], [2, 7, 3], [0, 4, 6],
                [0, 6, 2], [1, 3, 7], [1, 7, 5]]
        for axis, expected in enumerate((6, 3, 2)):
            loops = chained(section(corners[rows], axis, 0.5))
            self.assertEqual(1, len(loops))
            x, y = np.delete(loops[0], axis, axis=1).T
            self.assertAlmostEqual(expected, 0.5 * abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)))
        self.assertEqual([], chained(section(corners[rows], 0, 5.0)))


class Surfaces(unittest.TestCase):
    """reporting.surfaces and reporting.shading."""

    @classmethod
    def setUpClass(cls) -> None:
        cls.space = Run(RESULTS.run("dam_break_3d", "shaded", "/grid/cells=[8,4,8]", "/time/end=0.02",
                                    "/time/step=0.01", "/output/every=0.02", '/output/surface="vtp"'))

    def test_lines_become_loops_whatever_their_order(self) -> None:
        lines = np.array([[0, 1], [2, 0], [1, 2], [6, 3], [4, 5], [3, 4], [5, 6]])
        loops = loops_of(Surface(np.zeros((7, 2)), lines[[4, 0, 6, 2, 1, 3, 5]]))
        self.assertEqual({(0, 1, 2), (3, 4, 5, 6)}, {tuple(np.roll(loop, -loop.argmin())) for loop in loops})

    def test_runs_without_surface_and_in_space_have_no_lines(self) -> None:
        kept = []
        self.assertIsNone(packed_surfaces(self.space, kept.append))
        plane = Run(RESULTS.run("dam_break", "no_surface", "/time/end=0.004"))
        self.assertIsNone(packed_surfaces(plane, kept.append))
        self.assertEqual("", surface_section(plane, [0.0]))
        self.assertEqual([], kept)

    def test_what_is_coarsened_keeps_its_shape_in_fewer_triangles(self) -> None:
        grids = np.meshgrid(np.linspace(0, np.pi, 61), np.linspace(0, 2 * np.pi, 121))
        polar, around = (grid.ravel() for grid in grids)
        points = np.column_stack([np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar)])
        first = (61 * np.arange(120)[:, None] + np.arange(60)).ravel()
        triangles = np.concatenate([np.column_stack([first, first + 1, first + 62]),
                                    np.column_stack([first, first + 62, first + 61])])
        lost = []
        for cell, fewer in ((0.1, 3), (0.2, 12)):
            few = coarsened(Surface(points, triangles), cell)
            self.assertLess(len(few.elements), len(triangles) / fewer)
            a, b, c = (few.points[few.elements[:, k]] for k in range(3))
            lost.append(1 - abs(np.sum(a * np.cross(b, c))) / 6 / (4 / 3 * np.pi))
        # Means of a cap lie within the ball: 0.027 of its volume is lost with the finer cubes, 0.067 with the others.
        self.assertLess(lost[0], 0.04)
        self.assertLess(lost[0], 0.5 * lost[1])
        self.assertEqual(0, len(coarsened(Surface(0.01 + 0.001 * points, triangles), 0.2).elements))

    def test_the_picture_of_a_surface_has_the_column_where_it_is(self) -> None:
        from matplotlib.image import imread

        picture = imread(BytesIO(shaded(self.space, 0)))
        blue = (picture[:, :, 3] > 0.9) & (picture[:, :, 2] > picture[:, :, 0] + 0.1)
        rows, columns = np.nonzero(blue)
        # A quarter of the width of the box, half of its height, at the left in front.
        self.assertGreater(blue.mean(), 0.08)
        self.assertLess(blue.mean(), 0.25)
        self.assertLess(columns.max(), 0.6 * blue.shape[1])
        self.assertGreater(rows.min(), 0.3 * blue.shape[0])
        # The front and the right side are lit differently, so is what is above.
        self.assertGreaterEqual(len(np.unique(np.round(picture[blue][:, 2], 1))), 3)

    def test_a_page_on_a_run_in_space_has_a_picture_per_time_of_the_strip(self) -> None:
        section = surface_section(self.space, [0.0, 0.02])
        self.assertEqual(2, section.count("<img "))
        self.assertIn("0.02 s</figcaption>", section)


class WhileItRuns(unittest.TestCase):
    """A report of a run that goes on."""

    def test_who_reads_does_not_make_the_run_fail(self) -> None:
        folder = RESULTS.work / "live"
        command = [RESULTS.program, "run", RESULTS.source / "scenes/paper/dam_break_tpic.json", "--out", folder, "--quiet",
                   "--threads", "1", "--set", "/time/end=1", "--set", "/output/every=0.01"]
        with subprocess.Popen(command) as going_on, self.fields_of(folder) as file:
            frames = len(file["particles"])
            self.assertEqual(0, going_on.wait())
        self.assertLess(frames, 101)

    def fields_of(self, folder: Path) -> contextlib.AbstractContextManager[h5py.File]:
        """As soon as there is a frame to read."""
        while True:
            with contextlib.suppress(NoResults):
                if len((run := Run(folder)).times) > 0:
                    return run.fields()
            time.sleep(0.002)


class Graphs(unittest.TestCase):
    """The graph of the systems."""

    @classmethod
    def setUpClass(cls) -> None:
        cls.run_ = Run(RESULTS.run("paper/dam_break_tpic", "graph", "/time/end=0.001"))

    def test_it_is_drawn_without_graphviz_too(self) -> None:
        empty = RESULTS.work / "empty"
        empty.mkdir()
        path, os.environ["PATH"] = os.environ["PATH"], str(empty)
        self.addCleanup(os.environ.__setitem__, "PATH", path)
        drawing = draw_graph(self.run_, RESULTS.program)
        self.assertEqual(len(drawing.systems), drawing.svg.count('class="node system"'))
        self.assertIn("<title>s0-&gt;s1</title>", drawing.svg)

    def test_a_program_that_is_not_there_or_refuses_is_said(self) -> None:
        self.assertIn("--program", draw_graph(self.run_, None).sentence)
        self.assertIn("/nowhere/minamo", draw_graph(self.run_, Path("/nowhere/minamo")).sentence)
        self.assertIn("false graph", draw_graph(self.run_, Path(shutil.which("false"))).sentence)


if __name__ == "__main__":
    unittest.main(verbosity=2)
