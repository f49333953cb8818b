"""The page on a run in 2-D, seen in a browser."""

from __future__ import annotations

import json
import shutil

import h5py
import numpy as np
from page_case import PageTest, main
from results import RESULTS, summary


class InThePlane(PageTest):
    """The first tenth of a second of the dam break, six frames."""

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.folder = RESULTS.run("paper/dam_break_tpic", "dam_break", "/time/end=0.1", "/time/step=0.005",
                                 "/output/every=0.02", '/output/surface="ply"')
        cls.page = RESULTS.page(cls.folder)

    def test_a_page_loads_nothing_but_itself(self) -> None:
        self.open(self.page)
        self.assertEqual(0, self.js("performance.getEntriesByType('resource').length"))

    def test_particles_are_where_fields_h5_has_them(self) -> None:
        self.open(self.page)
        shown = self.js("""((particles) => [...Array(particles.frames).keys()].map((k) =>
          [...Array(particles.rows).keys()].map((p) => particles.place(k, p))))(app.panels[0].particles)""")
        with h5py.File(self.folder / "fields.h5") as file:
            stored = [file[f"particles/{k}/position"][:][np.argsort(file[f"particles/{k}/id"][:])] for k in range(6)]
        # 16 bits over a range of at most 0.3 m: off by 0.3/65535/2 m = 2.3e-6 m, and rounding.
        np.testing.assert_allclose(shown, stored, rtol=0, atol=2.4e-6)

    def test_every_field_of_fields_h5_can_be_chosen_and_has_its_true_range(self) -> None:
        self.open(self.page)
        before = self.picture()
        with h5py.File(self.folder / "fields.h5") as file:
            frames = [file[f"particles/{k}"] for k in range(6)]
            pressure, gradient, velocity = (np.array([frame[name][:] for frame in frames], float)
                                            for name in ("pressure", "velocity_gradient", "velocity"))
        expected = {"speed": np.linalg.norm(velocity, axis=2), "pressure": pressure,
                    "vorticity": gradient[..., 3] - gradient[..., 1],
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

    def test_the_particle_under_the_pointer_tells_its_values(self) -> None:
        self.open(self.page)
        self.js("app.player.jump(0.1)")
        self.browser.settle()
        x, y, px, py = self.js("""((panel) => {
          const edge = panel.canvas.getBoundingClientRect();
          const [px, py] = panel.projection.point(panel.particles.place(5, 700));
          return [edge.left + px, edge.top + py, ...panel.particles.place(5, 700)];
        })(app.panels[0])""")
        self.browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)
        self.browser.settle()
        with h5py.File(self.folder / "fields.h5") as file:
            frame = file["particles/5"]
            place, velocity = frame["position"][:], frame["velocity"][:]
        nearest = np.argmin(np.linalg.norm(place - [px, py], axis=1))
        said = self.text(".tip")
        # 4 digits are shown of 16 bits over 0 ... 1 m/s.
        speed = float(said.split("speed ")[1].split()[0])
        self.assertAlmostEqual(np.linalg.norm(velocity[nearest]), speed, delta=2e-4)

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

    def test_the_surface_of_the_liquid_is_drawn_around_it(self) -> None:
        self.open(self.page)
        for frame in range(6):
            loops = [np.array(loop).T for loop in self.js(f"app.panels[0].particles.surfaces.at({frame})")]
            area = sum(0.5 * (x @ np.roll(y, -1) - y @ np.roll(x, -1)) for x, y in loops)
            self.assertAlmostEqual(1, area / (0.146 * 0.292), delta=0.01)
        self.assertIn("line: the surface of the liquid", self.text(".note"))
        # In the middle of the upper side of the column: the liquid below it is lighter, and nothing is above.
        darkest = self.js("""((panel) => {
          const [x, y] = panel.projection.point([0.073, 0.292]).map((at) => at * devicePixels());
          const data = panel.context.getImageData(Math.round(x), Math.round(y) - 3, 1, 6).data;
          return Math.min(...[0, 1, 2, 3, 4, 5].map((k) => data[4*k] + data[4*k + 1] + data[4*k + 2]));
        })(app.panels[0])""")
        self.assertLess(darkest, 130)

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


if __name__ == "__main__":
    main()
