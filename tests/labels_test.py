"""Names in figures: none is cut off by the edge of the picture, none is printed over another. Runs are made up. In the
environment: WORK."""

import json
import os
import shutil
import sys
import unittest
from itertools import combinations
from pathlib import Path
from unittest import mock

import h5py
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tools"))

from figuring import movies  # noqa: E402
from figuring.documents import DOCUMENTS  # noqa: E402
from figuring.fields import find_field  # noqa: E402
from figuring.frontier import draw_frontier  # noqa: E402
from figuring.labels import width_of, wrapped  # noqa: E402
from figuring.layout import WIDTH  # noqa: E402
from figuring.plots import draw_history, draw_systems  # noqa: E402
from figuring.strips import Strip, draw_strip  # noqa: E402
from reporting.references import Curves  # noqa: E402
from reporting.runs import Run  # noqa: E402

WORK = Path(os.environ["WORK"])
TIMES = (0, 0.1, 0.2, 0.3)
LONG = "Water that falls on a tank of honey with a paddle, for $5, grid"
GAUGE = "a_gauge_behind_the_second_step_of_the_weir"


def made_up(name, box, title, fluids=(), columns=(), systems=("p2g", "solve"), until=0.3):
    """A run with a few particles in a box."""
    folder = WORK / name
    folder.mkdir(parents=True)
    high = np.array(box, float)
    scene = {"title": title, "dimension": len(box), "walls": "slip", "time": {"end": 0.3, "step": 1e-3},
             "grid": {"low": [0] * len(box), "high": box, "cells": [max(1, round(12 * b / box[0])) for b in box]},
             "particles": [{"per_cell": 2}], "body_force": [0] * (len(box) - 1) + [-9.81]}
    scene |= {"fluids": {fluid: {} for fluid in fluids}} if fluids else {"fluid": {"density": 1000, "viscosity": 1}}
    (folder / "scene.json").write_text(json.dumps(scene))
    random = np.random.default_rng(1)
    with h5py.File(folder / "fields.h5", "w") as file:
        for k, time in enumerate(t for t in TIMES if t <= until):
            frame = file.create_group(f"particles/{k}")
            frame.attrs["time"] = time
            frame["id"] = np.arange(60)
            frame["position"] = random.uniform(0, 0.5, (60, len(box))) * high
            frame["velocity"] = random.normal(size=(60, len(box)))
            frame["pressure"] = 1e5 * random.normal(size=60)
            if fluids:
                frame["fluid"] = np.arange(60) % len(fluids) * 1.0
    names = ["step", "time", "dt", "kinetic_energy", "potential_energy", "momentum_x", "max_speed", *columns]
    rows = [[k, 0.006 * k, 1e-3, *(10.0**j * np.sin(k + j) for j in range(len(names) - 3))] for k in range(50)]
    (folder / "history.csv").write_text("".join(",".join(map(str, row)) + "\n" for row in [names, *rows]))
    rows = [{"name": system, "seconds": 9 / (k + 1)} for k, system in enumerate(systems)]
    (folder / "summary.json").write_text(json.dumps({"status": "done", "time": until, "wall_s": 12, "systems": rows}))
    return Run(folder)


def words_of(figure):
    """All words that are drawn, and their boxes in pixels."""
    found, draw = {}, Text.draw

    def noted(text, renderer, *more):
        draw(text, renderer, *more)
        if text.get_visible() and text.get_text().strip():
            found[id(text)] = (text.get_text(), text.get_window_extent(renderer))

    with mock.patch.object(Text, "draw", noted):
        FigureCanvasAgg(figure).draw()
    return list(found.values())


class Labels(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(WORK, ignore_errors=True)

    def runs(self, count, box, **more):
        return [made_up(f"{self.id()}_{count}_{box}_{k}", box, f"{LONG} {k}", **more) for k in range(count)]

    def expect_room(self, figure, *what):
        """A pixel of a hundred per inch is rounding."""
        with self.subTest(what):
            words = words_of(figure)
            self.assertGreater(len(words), 3)
            for text, box in words:
                inside = box.x0 > -1 and box.y0 > -1 and box.x1 < figure.bbox.width + 1 and box.y1 < figure.bbox.height + 1
                self.assertTrue(inside, f"cut off: {text}")
            for (text, a), (other, b) in combinations(words, 2):
                over = min(a.x1, b.x1) - max(a.x0, b.x0) > 1 and min(a.y1, b.y1) - max(a.y0, b.y0) > 1
                self.assertFalse(over, f"one over the other: {text} / {other}")

    def test_strips_of_tanks_of_every_shape(self):
        for count, box in ((3, [1, 1]), (3, [4, 0.4]), (1, [0.03, 0.6]), (3, [1e-5, 1e-5]), (3, [0.4, 0.4, 4])):
            runs = self.runs(count, box)
            self.expect_room(draw_strip(Strip(runs, list(TIMES), find_field(runs, "speed"))), box, count)

    def test_a_long_box_in_space_whose_depth_is_told_beside_the_bar(self):
        runs = self.runs(1, [8.976, 2.244, 2.244])
        figure = draw_strip(Strip(runs, list(TIMES), find_field(runs, "speed"), across=2))
        self.expect_room(figure)
        bar = figure.axes[-1].get_window_extent()
        for text, box in words_of(figure):
            self.assertFalse(box.overlaps(bar), f"over the bar of colours: {text}")

    def test_strips_with_a_legend_or_names_of_liquids_or_where_a_run_has_ended(self):
        lines = [Curves(name, 0, [np.zeros((2, 2))])
                 for name in ("interFoam of the finest mesh, 160 x 160 cells", "measured by others in 1952")]
        fluids = ("water of the river, cold", "oil from a leaking tank, very thick")
        runs = self.runs(1, [1, 1])
        self.expect_room(draw_strip(Strip(runs, [0], find_field(runs, "velocity_x"), lines, corners=False)), "lines")
        runs = self.runs(1, [0.4, 4], fluids=fluids)
        self.expect_room(draw_strip(Strip(runs, [0, 0.1], find_field(runs, "fluid"))), "liquids")
        runs = [*self.runs(1, [0.1, 1.1]), made_up("short", [0.1, 1.1], "short", until=0.1)]
        self.expect_room(draw_strip(Strip(runs, [0, 0.3], find_field(runs, "speed"))), "ended")

    def test_histories_and_systems_of_several_runs(self):
        columns = [f"{GAUGE}_{what}" for what in ("pressure", "velocity_x", "force")]
        systems = [f"system_{k}_with_a_name_as_long_as_names_may_be_and_longer" for k in range(20)]
        runs = self.runs(4, [1, 1], columns=columns, systems=systems)
        self.expect_room(draw_history(runs, WIDTH), "history")
        self.expect_room(draw_systems(runs, WIDTH), "systems")

    def test_movies(self):
        runs = self.runs(4, [0.3, 1])
        with mock.patch.object(movies, "FFMpegWriter") as writer:
            movies.write_movie(WORK / "movie.mp4", runs, find_field(runs, "speed"), None, None)
        self.expect_room(writer.return_value.saving.call_args.args[0])

    def test_the_picture_of_errors_against_costs(self):
        self.expect_room(draw_frontier(DOCUMENTS["readme"].studies, WIDTH))

    def test_a_name_is_broken_where_it_can_be_and_keeps_its_ends(self):
        self.assertEqual(wrapped("a short name", 5, 9), "a short name")
        lines = wrapped(LONG, 1.5, 9, 9).split("\n")
        self.assertEqual(" ".join(lines), LONG.replace("$", r"\$"))
        self.assertLessEqual(max(width_of(line.replace(r"\$", "$"), 9) for line in lines), 1.5)
        cut = wrapped(LONG, 1.5, 9, 2)
        self.assertEqual(cut.count("\n"), 1)
        self.assertTrue(cut.startswith("Water") and cut.endswith("grid") and "…" in cut, cut)
        self.assertEqual(wrapped(GAUGE, 2, 9).replace("\n", ""), GAUGE)


if __name__ == "__main__":
    unittest.main()
