"""Opens reports of small runs in a browser and looks at them: report_test.py SOURCE PROGRAM WORK."""

from __future__ import annotations

import json
import shutil
import sys
import unittest
from pathlib import Path

import h5py
import numpy as np
from browser import Browser, find_browser
from results import Results, summary

RESULTS: Results  # of the command line
SKIPPED = 77  # what ctest takes for a skipped test

# Pixels of the canvas of panel k, by way of a copy, so that reading them does not change how it draws.
PIXELS = """((canvas) => {
  const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", {willReadFrequently: true});
  copy.drawImage(canvas, 0, 0);
  return copy.getImageData(0, 0, canvas.width, canvas.height).data;
})(app.panels[%d].canvas)"""

# How many differ from the corner, which nothing is drawn over, and all as one number.
PICTURE = """((data) => {
  const words = new Uint32Array(data.buffer);
  let drawn = 0, hash = 0;
  for (const word of words) { drawn += word !== words[0]; hash = (31 * hash + word) >>> 0; }
  return {drawn, hash, corner: data[0]};
})(%s)"""

# How many have about the colour of references, which no colour map has in light mode.
REDS = """((data) => {
  let found = 0;
  for (let at = 0; at < data.length; at += 4) found += data[at] > 200 && data[at + 1] < 90 && data[at + 2] < 90;
  return found;
})(%s)"""


class PageTest(unittest.TestCase):
    """Every test opens its page anew, in the one browser, and fails if the console complains."""

    @classmethod
    def setUpClass(cls) -> None:
        cls.browser = cls.enterClassContext(Browser())

    def open(self, page: Path, **how: object) -> None:
        self.browser.complaints.clear()
        self.browser.open(page, **how)
        self.addCleanup(lambda: self.assertEqual([], self.browser.complaints))

    def js(self, script: str) -> object:
        return self.browser.run(script)

    def choose(self, control: str, value: str, event: str = "change") -> None:
        self.js(f"{{const c = document.getElementById('{control}'); c.value = {json.dumps(value)};"
                f"c.dispatchEvent(new Event('{event}', {{bubbles: true}}));}}")
        self.browser.settle()

    def click(self, selector: str) -> None:
        self.js(f"document.querySelector({json.dumps(selector)}).dispatchEvent(new MouseEvent('click', {{bubbles: true}}))")
        self.browser.settle()

    def picture(self, k: int = 0) -> dict[str, int]:
        return self.js(PICTURE % (PIXELS % k))

    def reds(self) -> int:
        return self.js(REDS % (PIXELS % 0))

    def text(self, selector: str) -> str:
        return self.js(f"document.querySelector({json.dumps(selector)}).textContent")


class InThePlane(PageTest):
    """The first tenth of a second of the dam break, six frames."""

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.folder = RESULTS.run("dam_break", "dam_break", "/time/end=0.1", "/time/step=0.005", "/output/every=0.02")
        cls.page = RESULTS.page(cls.folder)

    def test_a_page_loads_nothing_but_itself(self) -> None:
        self.open(self.page)
        self.assertEqual(0, self.js("performance.getEntriesByType('resource').length"))

    def test_particles_are_where_fields_h5_has_them(self) -> None:
        self.open(self.page)
        shown = self.js("[...Array(app.panels[0].particles.frames).keys()].map((k) => "
                        "[...Array(app.panels[0].particles.rows).keys()].map((p) => app.panels[0].particles.place(k, p)))")
        with h5py.File(self.folder / "fields.h5") as file:
            stored = [file[f"particles/{k}/position"][:][np.argsort(file[f"particles/{k}/id"][:])] for k in range(6)]
        # 16 bits over a range of at most 0.3 m: off by 0.3/65535/2 m = 2.3e-6 m, and rounding.
        np.testing.assert_allclose(shown, stored, rtol=0, atol=2.4e-6)

    def test_every_field_of_fields_h5_can_be_chosen_and_has_its_true_range(self) -> None:
        self.open(self.page)
        before = self.picture()
        with h5py.File(self.folder / "fields.h5") as file:
            frames = [file[f"particles/{k}"] for k in range(6)]
            pressure = np.array([frame["pressure"][:] for frame in frames])
            gradient = np.array([frame["velocity_gradient"][:] for frame in frames])
            speed = np.linalg.norm([frame["velocity"][:] for frame in frames], axis=2)
        expected = {"speed": speed, "pressure": pressure, "vorticity": gradient[..., 2] - gradient[..., 1],
                    "velocity gradient, norm": np.linalg.norm(gradient, axis=2)}
        names = self.js("[...document.getElementById('field').options].map((option) => option.value)")
        self.assertEqual({*expected, "velocity x", "velocity y", "divergence"}, set(names))
        for name, values in expected.items():
            self.choose("field", name)
            self.browser.wait(f"app.field === {json.dumps(name)}")
            self.browser.settle()
            low, high = self.js("[app.colourBar.field.least, app.colourBar.field.most]")
            self.assertAlmostEqual(values.min(), low, delta=1e-9 * abs(values).max())
            self.assertAlmostEqual(values.max(), high, delta=1e-9 * abs(values).max())
            self.assertIn(name, self.text("#colour-bar .title"))
        self.choose("field", "pressure")
        self.browser.settle()
        self.assertNotEqual(before["hash"], self.picture()["hash"])

    def test_the_picture_has_the_column_and_changes_with_the_slider(self) -> None:
        self.open(self.page)
        start = self.picture()
        area = self.js("app.panels[0].projection.scale ** 2") * 0.146 * 0.292
        # Discs of 1.1 spacings leave gaps of a few per cent between them; the walls are a few thousand pixels more.
        self.assertGreater(start["drawn"], 0.9 * area)
        self.assertLess(start["drawn"], 1.1 * area + 5000)
        self.choose("time", "3", "input")
        self.assertAlmostEqual(0.06, self.js("app.time"), delta=1e-9)
        self.assertNotEqual(start["hash"], self.picture()["hash"])
        self.assertIn("0.06", self.text("#time-label"))

    def test_play_goes_on_to_the_end_and_stops_there(self) -> None:
        self.open(self.page)
        start = self.picture()
        self.choose("speed", "0.1")
        self.click("#play")
        self.browser.wait("app.time > 0.02 && app.time < 0.1")
        self.browser.wait("!app.playing")
        self.browser.settle()
        self.assertAlmostEqual(0.1, self.js("app.time"), delta=1e-9)
        self.assertNotEqual(start["hash"], self.picture()["hash"])

    def test_keys_play_step_zoom_and_put_back(self) -> None:
        self.open(self.page)
        start = self.picture()
        self.browser.press("ArrowRight", "ArrowRight")
        self.assertAlmostEqual(0.02, self.js("app.time"), delta=1e-9)
        self.browser.press("End", "End")
        self.assertAlmostEqual(0.1, self.js("app.time"), delta=1e-9)
        self.browser.press("Home", "Home")
        self.browser.press("+")
        self.assertNotEqual(start["hash"], self.picture()["hash"])
        self.browser.press("0")
        self.assertEqual(start["hash"], self.picture()["hash"])
        self.browser.press(" ", "Space")
        self.assertTrue(self.js("app.playing"))

    def test_a_picture_of_the_strip_leads_to_its_time(self) -> None:
        self.open(self.page)
        self.assertEqual(6, self.js("document.querySelectorAll('#strip button canvas').length"))
        self.click("#strip button:nth-child(4)")
        self.assertAlmostEqual(0.06, self.js("app.time"), delta=1e-9)
        self.assertTrue(self.js("document.querySelector('#strip button:nth-child(4)').classList.contains('current')"))

    def test_histories_are_those_of_history_csv_and_follow_the_time(self) -> None:
        self.open(self.page)
        history = np.genfromtxt(self.folder / "history.csv", delimiter=",", names=True)
        titles = self.js("report.plots.map((plot) => plot.title)")
        for title in ("energy", "momentum", "largest speed", "overlap / volume", "iterations"):
            self.assertIn(title, titles)
        self.assertEqual(len(titles), self.js("document.querySelectorAll('#plots canvas').length"))
        time, kinetic, _, total = self.js("app.plots.drawn[0].data.map((column) => [...column])")
        np.testing.assert_array_equal(history["time"], time)
        np.testing.assert_array_equal(history["kinetic_energy"], kinetic)
        np.testing.assert_array_equal(history["kinetic_energy"] + history["potential_energy"], total)
        drawn = self.js("""app.plots.drawn.map((plot) => {
          const canvas = plot.root.querySelector("canvas");
          const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", {willReadFrequently: true});
          copy.drawImage(canvas, 0, 0);
          const data = copy.getImageData(0, 0, canvas.width, canvas.height).data;
          let blue = 0;
          for (let at = 0; at < data.length; at += 4) blue += data[at] < 60 && data[at + 2] > 120 && data[at + 3] > 200;
          return blue; })""")
        self.assertTrue(all(pixels > 20 for pixels in drawn), drawn)
        self.js("app.player.jump(0.06)")
        line = "new DOMMatrix(app.plots.drawn[0].cursorLine.style.transform).m41"
        self.assertAlmostEqual(self.js("app.plots.drawn[0].valToPos(0.06, 'x')"), self.js(line), delta=0.01)

    def test_tables_say_what_summary_json_says(self) -> None:
        self.open(self.page)
        result = summary(self.folder)
        balance = self.text("#balance")
        for value in (result["conservation"]["mass"], result["conservation"]["energy"],
                      result["conservation"]["initial"]["energy"], result["conservation"]["overlap_max"]):
            self.assertIn(f"{value:.6g}", balance)
        rows = self.js("[...document.querySelectorAll('.profile tr')].map((row) => "
                       "[...row.cells].map((cell) => cell.textContent))")
        shown = {row[0]: row[1:3] for row in rows}
        dearest = max(result["systems"], key=lambda row: row["seconds"])
        self.assertEqual([f"{dearest['seconds']:.3g} s", f"{100 * dearest['share']:.1f} %"], shown[dearest["name"]])
        # Each of 16 rows is rounded to 0.05 %.
        self.assertAlmostEqual(100, sum(float(row[2].split()[0]) for row in rows), delta=0.8)
        self.assertIn(f"{result['particles']} particles", self.text(".headline"))

    def test_the_surface_of_interfoam_is_drawn_at_its_times(self) -> None:
        self.open(self.page)
        self.assertEqual(0, self.reds())
        self.js("app.player.jump(0.1)")
        self.browser.settle()
        self.assertGreater(self.reds(), 100)
        self.assertIn("interFoam at 0.1 s", self.text(".note"))

    def test_the_graph_of_the_systems_is_drawn_or_the_page_says_what_is_missing(self) -> None:
        self.open(self.page)
        if shutil.which("dot"):
            self.assertEqual(1, self.js("document.querySelectorAll('#graph svg .node[id=system-advect]').length"))
            self.click("#graph .node[id=system-advect]")
            self.assertIn("write: particle.position", self.text("#graph pre").replace("update", "write"))
        else:
            self.assertIn("graphviz", self.text("#graph"))
        self.assertIn("solve_block", self.text("#graph"))

    def test_dark_mode_follows_the_system_and_the_button(self) -> None:
        brightness = "getComputedStyle(document.body).backgroundColor.match(/\\d+/g).map(Number)[0]"
        self.open(self.page, dark=True)
        self.assertLess(max(self.js(brightness), self.picture()["corner"]), 80)
        self.click("#theme")
        self.assertGreater(min(self.js(brightness), self.picture()["corner"]), 200)
        self.open(self.page)
        self.assertGreater(min(self.js(brightness), self.picture()["corner"]), 200)

    def test_nothing_is_wider_than_a_phone(self) -> None:
        self.open(self.page, width=390, height=844, pixels=2)
        self.assertEqual(390, self.js("document.documentElement.scrollWidth"))
        self.assertGreater(self.picture()["drawn"], 5000)


class InSpace(PageTest):
    """A ball that flattens: no walls near, an exact solution."""

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.folder = RESULTS.run("drop_3d", "drop_3d", "/grid/cells=[12,12,12]", "/particles/0/per_cell=2",
                                 "/time/step=0.05", "/time/end=0.2")
        cls.page = RESULTS.page(cls.folder)

    def test_a_drag_turns_the_picture(self) -> None:
        self.open(self.page)
        before = self.picture()
        x, y = self.js("(({left, top, width, height}) => [left + width/2, top + height/2])"
                       "(app.panels[0].canvas.getBoundingClientRect())")
        for kind, at in (("mousePressed", x), ("mouseMoved", x + 120), ("mouseReleased", x + 120)):
            self.browser.call("Input.dispatchMouseEvent", type=kind, x=at, y=y, button="left", buttons=1, clickCount=1)
        self.browser.settle()
        after = self.picture()
        self.assertNotEqual(before["hash"], after["hash"])
        self.assertNotEqual(0, self.js("app.camera.turn - new Camera().turn"))
        self.assertGreater(after["drawn"], 5000)

    def test_a_slice_shows_less(self) -> None:
        self.open(self.page)
        whole = self.picture()["drawn"]
        self.choose("slice-axis", "x", "input")
        thin = self.picture()["drawn"]
        self.assertLess(thin, 0.7 * whole)
        self.choose("slice-at", "0", "input")  # at the wall, where no liquid is
        self.assertLess(self.picture()["drawn"], 0.5 * thin)

    def test_errors_against_the_exact_solution_are_shown(self) -> None:
        self.open(self.page)
        errors = summary(self.folder)["errors"]
        for field in ("velocity", "pressure"):
            self.assertIn(f"error of the {field}", self.text("#balance"))
            self.assertIn(f"{errors[field]:.6g}", self.text("#balance"))
            self.assertIn(f"error of the {field}", self.js("report.plots.map((plot) => plot.title)"))


class SideBySide(PageTest):
    """TPIC and FLIP."""

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        settings = ("/time/end=0.1", "/time/step=0.005", "/output/every=0.02")
        cls.folders = [RESULTS.run(scene, f"both/{scene}", *settings) for scene in ("dam_break", "dam_break_flip")]
        cls.page = RESULTS.page(*cls.folders, name="both.html")

    def test_two_runs_move_together(self) -> None:
        self.open(self.page)
        self.assertEqual(["TPIC", "FLIP"], self.js("[...document.querySelectorAll('.panel .name')].map((n) => n.textContent)"))
        before = [self.picture(0)["hash"], self.picture(1)["hash"]]
        self.choose("time", "5", "input")
        after = [self.picture(0)["hash"], self.picture(1)["hash"]]
        self.assertTrue(before[0] != after[0] and before[1] != after[1] and after[0] != after[1])

    def test_the_scale_of_colours_covers_both(self) -> None:
        self.open(self.page)
        speeds = []
        for folder in self.folders:
            with h5py.File(folder / "fields.h5") as file:
                speeds.append(max(np.linalg.norm(frame["velocity"][:], axis=1).max() for frame in file["particles"].values()))
        self.assertAlmostEqual(max(speeds), self.js("app.colourBar.field.most"), delta=1e-9)

    def test_what_differs_between_the_scenes_is_listed(self) -> None:
        self.open(self.page)
        keys = self.js("[...document.querySelectorAll('#differences th')].map((cell) => cell.textContent)")
        self.assertIn("/transfer/scheme", keys)
        self.assertNotIn("/grid/cells", keys)

    def test_every_history_has_a_curve_per_run(self) -> None:
        self.open(self.page)
        self.assertTrue(all(self.js("app.plots.drawn.map((plot) => plot.series.length === 3)")))


class WithCorners(PageTest):
    """The rotating square."""

    def test_the_corners_of_the_rotating_square_are_marked_where_theory_has_them(self) -> None:
        folder = RESULTS.run("rotating_square", "square", "/time/step=0.05", "/grid/cells=[50,50]",
                             "/particles/0/per_cell=3", "/time/end=1")
        self.open(RESULTS.page(folder))
        corners = self.js("report.runs[0].corners")
        at_end = np.array(corners["start"]) + np.array(corners["velocity"])
        # (L/2) (1 - wt, 1 + wt) at wt = 1, and its turned copies, about (2.5, 2.5).
        self.assertEqual({(2.5, 3.5), (2.5, 1.5), (1.5, 2.5), (3.5, 2.5)}, {tuple(np.round(place, 6)) for place in at_end})
        self.js("app.player.jump(1)")
        self.browser.settle()
        self.assertGreater(self.reds(), 40)


class WithoutResults(PageTest):
    """What a run that went wrong leaves, or none."""

    def test_a_folder_without_results_is_an_error_of_one_line(self) -> None:
        ended = RESULTS.report(RESULTS.work / "nothing")
        self.assertEqual(2, ended.returncode)
        self.assertIn("no results of minamo here", ended.stderr)
        self.assertEqual(1, len(ended.stderr.splitlines()))

    def test_a_failed_run_shows_its_message_and_what_it_wrote(self) -> None:
        folder = RESULTS.run("dam_break", "failed", '/body_force=[0, "-9.81/(t < 0.0032)"]', "/output/every=1e-3")
        self.open(RESULTS.page(folder))
        self.assertIn(summary(folder)["message"], self.text("pre.failed"))
        self.assertGreater(self.picture()["drawn"], 5000)

    def test_a_run_that_has_written_a_scene_alone_is_shown_as_that(self) -> None:
        folder = RESULTS.run("dam_break", "bare", "/time/end=0.001")
        for path in folder.iterdir():
            if path.name != "scene.json":
                path.unlink()
        self.open(RESULTS.page(folder))
        said = self.js("[...document.querySelectorAll('p.failed')].map((p) => p.textContent).join()")
        for part in ("no summary.json", "no frame in fields.h5", "no rows in history.csv"):
            self.assertIn(part, said)
        self.assertEqual(0, self.js("document.querySelectorAll('canvas').length"))

    def test_a_broken_fields_h5_is_named(self) -> None:
        folder = RESULTS.run("dam_break", "broken", "/time/end=0.01")
        (folder / "fields.h5").write_bytes(b"not HDF5")
        self.open(RESULTS.page(folder))
        self.assertIn("fields.h5 cannot be read", self.text("p.failed:not(#problem)"))
        self.assertGreater(self.js("document.querySelectorAll('#plots canvas').length"), 5)


def main() -> None:
    global RESULTS
    if find_browser() is None:
        print("Skipped: there is no chromium to open pages with. It comes with the package chromium (tools/packages).")
        sys.exit(SKIPPED)
    source, program, work = (Path(argument).resolve() for argument in sys.argv[1:4])
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    RESULTS = Results(source, program, work)
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=2)


if __name__ == "__main__":
    main()
