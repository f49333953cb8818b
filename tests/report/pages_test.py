"""Pages on runs in 3-D, on several runs, on runs that went wrong, seen in a browser."""

from __future__ import annotations

import h5py
import numpy as np
from page_case import PageTest, main
from results import RESULTS, summary

from reporting.runs import Run


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


class WithBodies(PageTest):
    """The mixer, 0.2 s, three frames."""

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.folder = RESULTS.run("mixer", "mixer", "/grid/cells=[20,20]", "/time/step=0.01", "/time/end=0.2",
                                 "/output/every=0.1")
        cls.page = RESULTS.page(cls.folder)

    def test_bodies_are_where_fields_h5_has_them(self) -> None:
        self.open(self.page)
        with h5py.File(self.folder / "fields.h5") as file:
            for frame in range(3):
                shown = self.js(f"app.panels[0].particles.bodies[0].placesAt({{frame: {frame}, part: 0}})")
                np.testing.assert_allclose(shown, file[f"bodies/{frame}/cross/points"][:], rtol=0, atol=1e-12)

    def test_between_frames_a_body_keeps_its_size(self) -> None:
        self.open(self.page)
        shown = np.array(self.js("app.panels[0].particles.bodies[0].placesAt({frame: 1, part: 0.5})"))
        np.testing.assert_allclose(np.linalg.norm(shown, axis=1).max(), np.hypot(0.3, 0.03), rtol=1e-9)

    def test_a_body_fills_its_part_of_the_picture(self) -> None:
        self.open(self.page)
        filled = self.js("((data, [r, g, b]) => {let found = 0; for (let k = 0; k < data.length; k += 4)"
                         " found += data[k] === r && data[k + 1] === g && data[k + 2] === b; return found;})"
                         "(app.panels[0].canvas.getContext('2d').getImageData(0, 0, app.panels[0].canvas.width,"
                         " app.panels[0].canvas.height).data, rgbOf(app.theme.solid))")
        area = self.js("app.panels[0].projection.scale ** 2") * (2 * 0.6 * 0.06 - 0.06**2)
        # Particles lie over the edges of the half in the liquid, a line over all of them.
        self.assertGreater(filled, 0.7 * area)
        self.assertLess(filled, area)

    def test_triangles_in_space_are_seen_turned_and_cut(self) -> None:
        ball = '{"name": "ball", "shape": {"ball": {"center": [0.4, 0.14, 0.1], "radius": 0.04}}, ' \
               '"motion": {"prescribed": {"rotation": {"rate": "5", "axis": [0, 1, 1]}}}}'
        folder = RESULTS.run("dam_break_3d", "ball", "/grid/cells=[16,8,16]", "/particles/0/per_cell=2",
                             "/time/end=0.04", "/time/step=0.01", "/output/every=0.02", f"/bodies=[{ball}]")
        bare = RESULTS.run("dam_break_3d", "no_ball", "/grid/cells=[16,8,16]", "/particles/0/per_cell=2",
                           "/time/end=0.04", "/time/step=0.01", "/output/every=0.02")
        drawn = []
        for each in (folder, bare):
            self.open(RESULTS.page(each))
            drawn.append([self.picture()["drawn"]])
            self.choose("slice-axis", "y", "input")
            drawn[-1].append(self.picture()["drawn"])
        for with_ball, without in zip(*drawn):
            self.assertGreater(with_ball, without + 2000)


class WithLiquids(PageTest):
    """Salt water under fresh water, two steps."""

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.folder = RESULTS.run("lock_exchange", "lock", "/grid/cells=[48, 8]", "/time/end=0.04", "/output/every=0.02")
        cls.page = RESULTS.page(cls.folder)

    def test_liquids_have_a_colour_each_and_the_bar_their_names(self) -> None:
        self.open(self.page)
        self.assertEqual(self.js("app.field"), "fluid")
        self.assertEqual(self.js("[...document.querySelectorAll('#colour-bar .ticks span')].map((s) => s.textContent)"),
                         ["fresh", "salt"])
        # Pixels of either colour, in the left half and in the right one.
        fresh, salt = self.js("""((panel, colours) => {
          const {width, height} = panel.canvas;
          const data = panel.canvas.getContext('2d').getImageData(0, 0, width, height).data;
          return colours.map(([r, g, b]) => {
            const found = [0, 0];
            for (let k = 0; k < data.length; k += 4)
              if (data[k] === r && data[k + 1] === g && data[k + 2] === b) ++found[(k / 4) % width < width / 2 ? 0 : 1];
            return found;
          });
        })(app.panels[0], ['#0072b2', '#d55e00'].map(rgbOf))""")
        self.assertGreater(min(fresh[1], salt[0]), 1000)
        self.assertLess(max(fresh[0], salt[1]), 200)  # discs on the boundary are half beyond it

    def test_another_field_has_its_range_again(self) -> None:
        self.open(self.page)
        hidden = "document.getElementById('range-low').hidden"
        self.assertTrue(self.js(hidden))
        self.choose("field", "speed")
        self.browser.wait("app.field === 'speed'")
        self.assertFalse(self.js(hidden))


class WithOpenings(PageTest):
    """A tap fills a basin."""

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.folder = RESULTS.run("tap", "tap", "/grid/cells=[48, 32]", "/time/end=0.3")
        cls.page = RESULTS.page(cls.folder)

    def test_every_frame_has_its_own_particles_where_fields_h5_has_them(self) -> None:
        self.open(self.page)
        shown = self.js("""((particles) => [...Array(particles.frames).keys()].map((k) =>
          [...Array(particles.rows).keys()].filter((p) => particles.id(k, p) >= 0)
            .map((p) => [particles.id(k, p), ...particles.place(k, p)])))(app.panels[0].particles)""")
        counts = []
        with h5py.File(self.folder / "fields.h5") as file:
            for frame, rows in enumerate(shown):
                stored = file[f"particles/{frame}"]
                order = np.argsort(stored["id"][:])
                ids, *places = np.array(sorted(rows)).T
                np.testing.assert_array_equal(ids, stored["id"][:][order])
                # 16 bits over at most 0.6 m: off by 0.6/65535/2 m = 4.6e-6 m, and rounding.
                np.testing.assert_allclose(places, stored["position"][:][order].T, rtol=0, atol=4.7e-6)
                counts.append(len(ids))
        self.assertGreater(counts[-1], counts[0])
        self.assertIn(f"{summary(self.folder)['particles']} at the end", self.text("#viewer"))
        for frame in (0, len(counts) - 1):
            self.js(f"app.player.jump(report.runs[0].times[{frame}])")
            self.browser.settle()
            self.assertIn(f"{counts[frame]} particles", self.text(".note"))

    def test_the_pointer_finds_those_that_are_there(self) -> None:
        self.open(self.page)
        for frame, expected in ((0, False), (-1, True)):  # in the jet, which has not begun at the start
            self.js(f"app.player.jump(report.runs[0].times.at({frame}))")
            self.browser.settle()
            found = self.js("""((panel) => {
              const frame = panel.particles.frameAt(app.time);
              const found = panel.particleAt(panel.projection.point([0.1125, 0.35]), frame);
              return found !== null && panel.particles.id(frame, found) >= 0; })(app.panels[0])""")
            self.assertEqual(expected, found)

    def test_between_frames_particles_come_and_leave_at_the_pace_of_the_others(self) -> None:
        folder = RESULTS.run("uniform_stream", "stream")
        self.open(RESULTS.page(folder))
        # A half of the way from frame 5 to frame 6, in metres.
        shown = np.array(self.js("""((panel) => {
          const {particles, projection} = panel, [x0, y0] = projection.point([0, 0]), found = [];
          forEachSeen({particles, projection, pixels: 1, slice: null, frame: 5, part: 0.5,
                       field: particles.fields.get(app.field), range: app.range}, 1, panel.width, panel.height,
                      (x, y) => found.push([(x - x0) / projection.scale, (y0 - y) / projection.scale]));
          return found; })(app.panels[0])"""))
        run = Run(folder)
        half = 0.5 * (run.times[6] - run.times[5]) * np.array([0.8, 0.5])
        first, before, after, last = map(run.frame, range(4, 8))
        comes = ~np.isin(after.id, before.id)
        leaves = ~np.isin(before.id, after.id)
        self.assertGreater(min(comes.sum(), leaves.sum()), 100)
        # One that is there at one output time alone, in a corner, stands still.
        forth = np.where(leaves & ~np.isin(before.id, first.id), 0, 1)[:, None] * half
        back = np.where(np.isin(after.id, last.id), 1, 0)[:, None] * half
        # Particles are not followed beyond where they are at output times, to a 40th of the box at most.
        places = np.concatenate([before.position + forth, (after.position - back)[comes]])
        both = [some[np.all((some > 0.025) & (some < 0.975), axis=1)] for some in (places, shown)]
        both = [some[np.lexsort(some.round(3).T)] for some in both]
        self.assertGreater(len(both[0]), 850)
        np.testing.assert_allclose(*both, rtol=0, atol=1e-4)


class Even(PageTest):
    """A stream in which nothing changes."""

    def test_a_history_that_is_constant_but_for_rounding_has_a_plot(self) -> None:
        self.open(RESULTS.page(RESULTS.run("uniform_stream", "even", "/time/end=0.2")))
        low, high = self.js("(({min, max}) => [min, max])(app.plots.drawn[0].scales.y)")
        self.assertLess(low, 440)
        self.assertGreater(high, 450)


class SideBySide(PageTest):
    """TPIC and FLIP."""

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        settings = ("/time/end=0.1", "/time/step=0.005", "/output/every=0.02")
        cls.folders = [RESULTS.run(scene, f"both/{scene}", *settings) for scene in ("paper/dam_break_tpic", "paper/dam_break_flip")]
        cls.page = RESULTS.page(*cls.folders, name="both.html")

    def test_two_runs_move_together(self) -> None:
        self.open(self.page)
        names = self.js("[...document.querySelectorAll('.panel .name')].map((name) => name.textContent)")
        self.assertEqual(["TPIC", "FLIP"], names)
        before = [self.picture(0)["hash"], self.picture(1)["hash"]]
        self.choose("time", "5", "input")
        after = [self.picture(0)["hash"], self.picture(1)["hash"]]
        self.assertTrue(before[0] != after[0] and before[1] != after[1] and after[0] != after[1])

    def test_the_scale_of_colours_covers_both(self) -> None:
        self.open(self.page)
        speeds = []
        for folder in self.folders:
            with h5py.File(folder / "fields.h5") as file:
                speeds += [np.linalg.norm(frame["velocity"][:].astype(float), axis=1).max() for frame in file["particles"].values()]
        self.assertAlmostEqual(np.max(speeds), self.js("app.colourBar.field.most"), delta=1e-9)

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
        folder = RESULTS.run("paper/rotating_square_tpic", "square", "/time/step=0.05", "/grid/cells=[50,50]",
                             "/particles/0/per_cell=3", "/time/end=1")
        self.open(RESULTS.page(folder))
        corners = self.js("report.runs[0].corners")
        at_end = np.array(corners["start"]) + np.array(corners["velocity"])
        # (L/2) (1 - wt, 1 + wt) at wt = 1, and its turned copies, about (2.5, 2.5).
        expected = {(2.5, 3.5), (2.5, 1.5), (1.5, 2.5), (3.5, 2.5)}
        self.assertEqual(expected, {tuple(np.round(place, 6)) for place in at_end})
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

    def test_a_scene_that_is_none_and_a_place_that_cannot_be_written_are_errors_of_one_line(self) -> None:
        wrong = RESULTS.work / "wrong"
        wrong.mkdir()
        (wrong / "scene.json").write_text('{"dimension": 2}')
        (RESULTS.work / "broken_json").mkdir()
        (RESULTS.work / "broken_json/scene.json").write_text("{")
        good = RESULTS.run("paper/dam_break_tpic", "short", "/time/end=0.001")
        for arguments, part in (([wrong], "no /grid"), ([RESULTS.work / "broken_json"], "cannot be read as JSON"),
                                ([good, "--out", RESULTS.work / "no/folder.html"], "no/folder.html")):
            with self.subTest(part):
                ended = RESULTS.report(*arguments)
                self.assertEqual((2, 1), (ended.returncode, len(ended.stderr.splitlines())), ended.stderr)
                self.assertIn(part, ended.stderr)

    def test_a_failed_run_shows_its_message_and_what_it_wrote(self) -> None:
        folder = RESULTS.run("paper/dam_break_tpic", "failed", '/body_force=[0, "-9.81/(t < 0.0032)"]', "/output/every=1e-3")
        self.open(RESULTS.page(folder))
        self.assertIn(summary(folder)["message"], self.text("pre.failed"))
        self.assertGreater(self.picture()["drawn"], 5000)

    def test_a_run_that_has_written_a_scene_alone_is_shown_as_that(self) -> None:
        folder = RESULTS.run("paper/dam_break_tpic", "bare", "/time/end=0.001")
        for path in folder.iterdir():
            if path.name != "scene.json":
                path.unlink()
        self.open(RESULTS.page(folder))
        said = self.js("[...document.querySelectorAll('p.failed')].map((p) => p.textContent).join()")
        for part in ("no summary.json", "no frame in fields.h5", "no rows in history.csv"):
            self.assertIn(part, said)
        self.assertEqual(0, self.js("document.querySelectorAll('canvas').length"))

    def test_a_broken_fields_h5_is_named(self) -> None:
        folder = RESULTS.run("paper/dam_break_tpic", "broken", "/time/end=0.01")
        whole = (folder / "fields.h5").read_bytes()
        for broken in (b"not HDF5", whole[:-1]):
            (folder / "fields.h5").write_bytes(broken)
            ended = RESULTS.report(folder)
            self.assertEqual(2, ended.returncode)
            self.assertRegex(ended.stderr, r"^\S*/broken: fields\.h5 cannot be read \(.*\)\n$")
        self.open(folder / "report.html")
        self.assertIn("fields.h5 cannot be read", self.text("p.failed:not(#problem)"))
        self.assertGreater(self.js("document.querySelectorAll('#plots canvas').length"), 5)


if __name__ == "__main__":
    main()
