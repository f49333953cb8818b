"""tools/validate: its gauges and figures against hand calculation, a run with stand-ins for the data, wrong input."""

import json
import sys
import unittest
from pathlib import Path

import numpy as np
from support import ROOT, WORK

TOOL = ROOT / "tools/validation"
sys.path[:0] = [str(TOOL), str(ROOT / "tests/support")]

import figures_of as figure  # noqa: E402
from case import Points  # noqa: E402
from cases import CASES  # noqa: E402
from forked import call  # noqa: E402
from gauges import front, height  # noqa: E402
from page import page  # noqa: E402
from runs import scene_file, scene_of, smoothed  # noqa: E402

import minamo  # noqa: E402


def validate(*arguments):
    return call(TOOL, list(map(str, arguments)))


def stand_ins(folder):
    """Files with the names and columns of the experiments' data, and numbers of no meaning."""
    folder.mkdir(parents=True, exist_ok=True)
    for case in CASES:
        for curve in case.curves:
            file = folder / curve.file
            columns = {c.column for other in CASES for c in other.curves if c.file == curve.file} | {curve.time_column}
            names = sorted(columns)
            rows = [",".join(str(1 + 0.1 * k) for _ in names) for k in range(80)]
            file.write_text("\n".join([",".join(names), *rows]) + "\n")
    return folder


class Figures(unittest.TestCase):
    x = np.linspace(0, 10, 1001)

    def test_rms_is_of_the_largest_value(self):
        ours, measured = Points(self.x, self.x + 1), Points(self.x[::50], self.x[::50])
        self.assertAlmostEqual(figure.rms()(ours, measured), 10)
        self.assertAlmostEqual(figure.rms(0, 5)(ours, measured), 20)

    def test_a_delay_is_found_and_taken_off(self):
        late = Points(self.x[::50] + 0.3, self.x[::50] ** 2)
        ours = Points(self.x, self.x**2)
        self.assertAlmostEqual(figure.delay(0.5)(ours, late), 0.3, delta=1e-3)
        self.assertLess(figure.rms_but_delay(0.5)(ours, late), 0.02)
        self.assertGreater(figure.rms()(ours, late), 2)
        self.assertAlmostEqual(figure.delay(0.5)(late, ours), 0)  # never earlier

    def test_slope_and_mean_are_relative(self):
        ours, measured = Points(self.x, 1.2 * self.x), Points(self.x[::50], self.x[::50])
        self.assertAlmostEqual(figure.slope(2, 8)(ours, measured), 20)
        self.assertAlmostEqual(figure.mean(2, 8)(ours, measured), 20)

    def test_arrival_is_later_than_measured(self):
        ours, measured = Points(self.x, (self.x > 5.5) * 1.0), Points(self.x, (self.x > 5) * 1.0)
        self.assertAlmostEqual(figure.arrival(0.5)(ours, measured), 10, delta=0.1)

    def test_peak_and_crests(self):
        measured = Points(self.x, np.sin(2 * np.pi * self.x))
        ours = Points(self.x, 0.9 * np.sin(2 * np.pi * self.x))
        self.assertAlmostEqual(figure.peak(0, 1)(ours, measured), -10)
        self.assertAlmostEqual(figure.crests(0, 10, 0.5)(ours, measured), -10)

    def test_smoothing_keeps_the_mean(self):
        noisy = Points(self.x, 3 + np.where(np.arange(1001) % 2, 1.0, -1.0))
        self.assertLess(np.abs(smoothed(noisy).y - 3).max(), 0.5)


class Gauges(unittest.TestCase):
    def test_front_and_height_of_a_column(self):
        sim = minamo.Simulation(scene_of(CASES[0], {}))
        a = 0.05715
        self.assertAlmostEqual(front()(sim), a, delta=1e-9)
        self.assertAlmostEqual(height(0.5 * a, 0.8 * a)(sim), 2 * a, delta=0.01 * a)


class Tool(unittest.TestCase):
    def test_every_scene_is_valid_at_every_resolution(self):
        for case in CASES:
            for label, changes in case.resolutions:
                with self.subTest(case=case.name, resolution=label):
                    self.assertEqual(minamo.check(scene_of(case, changes)), [])

    def test_a_run_writes_curves_picture_and_page(self):
        out = WORK / "out"
        done = validate("--experiments", stand_ins(WORK / "data"), "--out", out, "dam_break")
        self.assertEqual(done.returncode, 0, done.stderr)
        stored = json.loads((out / "results.json").read_text())["dam_break"]
        self.assertEqual(list(stored), ["L/20", "L/40"])
        self.assertEqual(stored["L/20"]["particles"], 7200)
        self.assertTrue((out / "dam_break.png").read_bytes().startswith(b"\x89PNG"))
        rows = (out / "dam_break.csv").read_text().splitlines()
        self.assertEqual(len(rows), 201)
        self.assertTrue(rows[1].startswith("0,1,1"), rows[1])  # the front at the start, over a
        self.assertIn("## Dam break", (out / "README.md").read_text())

    def test_results_of_other_resolutions_are_left_out(self):
        out = WORK / "stale"
        out.mkdir(exist_ok=True)
        of_before = {"L/10": {"figures": [1, 2], "particles": 1, "steps": 1, "cpu_s": 1}}
        (out / "results.json").write_text(json.dumps({CASES[1].name: of_before}))
        done = validate("--experiments", stand_ins(WORK / "other"), "--out", out, "dam_break")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(f"{CASES[1].name}: its results are of other resolutions", done.stdout)
        self.assertEqual(list(json.loads((out / "results.json").read_text())), ["dam_break"])

    def test_wrong_input_is_told_at_once(self):
        data = stand_ins(WORK / "some")
        (data / "koshizuka_oka_1996_front.csv").unlink()
        said = validate("--experiments", data, "dam_brake", "swayed_tank")
        self.assertEqual(said.returncode, 2)
        self.assertIn('no experiment "dam_brake"; closest "dam_break"', said.stderr)
        said = validate("--experiments", data)
        self.assertEqual(said.returncode, 2)
        self.assertIn("koshizuka_oka_1996_front.csv: no such file", said.stderr)
        said = validate("dam_break")
        self.assertEqual(said.returncode, 2)
        self.assertIn("--experiments DIR is missing", said.stderr)

    def test_the_page_is_that_of_its_numbers(self):
        folder = ROOT / "scenes/validation"
        stored = json.loads((folder / "results.json").read_text())
        self.assertEqual((folder / "README.md").read_text(), page(stored, scene_file))


if __name__ == "__main__":
    Path(WORK).mkdir(parents=True, exist_ok=True)
    unittest.main()
