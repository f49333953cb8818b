"""The folder of a run as arrays, and the picture of a simulation."""

import csv
import math
import unittest
import unittest.mock

import h5py
import numpy as np

import minamo
from support import ROOT, folder, in_space, program, scene


class Results(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.out = folder("results")
        cls.run_ = minamo.run(scene(), cls.out, threads=1)

    def test_history(self):
        with open(self.out / "history.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        history = self.run_.history
        self.assertEqual(list(history), list(rows[0]))
        self.assertEqual(len(history["time"]), 51)
        self.assertEqual(history["kinetic_energy"][-1], float(rows[-1]["kinetic_energy"]))

    def test_every_column_of_the_history_has_a_unit(self):
        self.assertEqual(list(self.run_.units), list(self.run_.history))
        self.assertEqual([self.run_.units[name] for name in ("time", "kinetic_energy", "momentum_x", "step")],
                         ["s", "J/m", "kg/s", "1"])

    def test_vectors_have_three_components_in_the_plane(self):
        frame = self.run_.particles()
        count = len(frame["id"])
        self.assertEqual([frame[name].shape for name in ("position", "velocity", "velocity_gradient")],
                         [(count, 2), (count, 3), (count, 9)])
        self.assertEqual({frame[name].dtype for name in ("position", "velocity", "pressure")}, {np.dtype("f4")})
        self.assertFalse(frame["velocity"][:, 2].any())
        self.assertFalse(frame["velocity_gradient"][:, [2, 5, 6, 7, 8]].any())
        self.assertTrue(frame["velocity_gradient"][:, [0, 1, 3, 4]].any(axis=0).all())

    def test_a_run_writes_the_fields_that_its_scene_names(self):
        for fields, expected in (("minimal", {"id", "position", "velocity", "pressure"}),
                                 (["mass"], {"id", "position", "mass"})):
            few = minamo.run(scene(output={"every": 0.1, "fields": fields, "precision": "double", "compression": 6}),
                             folder("few"), threads=1)
            self.assertEqual(set(few.particles()), expected)
            self.assertEqual(few.particles()["position"].dtype, np.dtype("f8"))
            np.testing.assert_allclose(few.particles()["position"], self.run_.particles()["position"], rtol=1e-7)

    def test_empty_cells_are_not_numbers(self):
        swirling = minamo.run(scene(body_force=["-y", "x"]), folder("swirl"), threads=1, steps=1)
        self.assertTrue(math.isnan(swirling.history["potential_energy"][0]))

    def test_frames(self):
        np.testing.assert_allclose(self.run_.times, [0, 0.05, 0.1, 0.15, 0.2], atol=0.004)
        self.assertEqual(len(self.run_), 5)
        with h5py.File(self.out / "fields.h5") as file:
            for name, data in file["particles/4"].items():
                np.testing.assert_array_equal(self.run_.particles(4)[name], data[()])
                np.testing.assert_array_equal(self.run_.particles()[name], data[()])
        self.assertEqual(self.run_.bodies(), {})
        for k in (5, -6):
            with self.assertRaisesRegex(IndexError, f"frame {k} of 5"):
                self.run_.particles(k)

    def test_bodies(self):
        out = folder("bodies")
        run = minamo.run(ROOT / "scenes/obstacle.json", out, threads=1, steps=2)
        self.assertTrue(run.bodies(0))

    def test_scene_and_summary(self):
        self.assertEqual(self.run_.scene["title"], "Falling block")
        self.assertEqual(self.run_.summary["status"], "done")
        self.assertIn("results", repr(minamo.results(self.out)))

    def test_no_run(self):
        with self.assertRaisesRegex(minamo.InputError, "scene.json: no such file\n  expected  the folder of a run"):
            minamo.Run(folder("none"))
        self.assertEqual(program("check", self.out / "scene.json").returncode, 0)


class Pictures(unittest.TestCase):
    def test_a_notebook_shows_the_particles(self):
        import matplotlib.image
        import io

        for described in (scene(), in_space()):
            sim = minamo.Simulation(described, threads=1)
            picture = matplotlib.image.imread(io.BytesIO(sim._repr_png_()))
            self.assertEqual(picture.shape[:2], (400, 600))
            # White paper and coloured particles: a third of the box.
            colored = (np.ptp(picture[..., :3], axis=2) > 0.2).mean()
            self.assertGreater(colored, 0.05)

    def test_a_picture_that_is_drawn_anew_while_steps_are_taken(self):
        try:
            import IPython.display
        except ImportError:
            self.skipTest("python3-ipykernel is not there")
        watched, run = (minamo.Simulation(scene(), threads=1) for _ in range(2))
        with unittest.mock.patch.object(IPython.display, "display") as display:
            steps = watched.watch(until=0.05, every=4, color="particle.pressure")
        self.assertEqual(steps, run.run(until=0.05))
        self.assertEqual(watched.time, run.time)
        (first,), place = display.call_args
        self.assertEqual(place, {"display_id": True})
        pictures = [first] + [call.args[0] for call in display.return_value.update.call_args_list]
        self.assertEqual(len(pictures), 1 + math.ceil(steps / 4))
        self.assertEqual(len({picture.data for picture in pictures}), len(pictures))
        with self.assertRaisesRegex(minamo.InputError, "every: out of range"):
            watched.watch(every=0)

    def test_any_column(self):
        sim = minamo.Simulation(scene(), threads=1)
        ax = sim.show("particle.pressure")
        self.assertEqual(ax.get_title(), "t = 0 s")
        self.assertIs(sim.show("particle.mass", ax), ax)


if __name__ == "__main__":
    unittest.main()
