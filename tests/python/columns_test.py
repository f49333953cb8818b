"""Columns as arrays: whose memory they are, what they show when, who may write."""

import gc
import unittest

import numpy as np

import minamo
from support import in_space, scene


def address(array):
    return array.__array_interface__["data"][0]


class Memory(unittest.TestCase):
    def test_a_million_particles_are_not_copied(self):
        many = scene(grid={"low": [0, 0], "high": [1, 1], "cells": [64, 64]},
                     particles=[{"shape": {"box": {"low": [0, 0], "high": [1, 1]}}, "per_cell": 16}])
        sim = minamo.Simulation(many, threads=2)
        x = sim["particle.position"]
        self.assertGreater(len(x), 1_000_000)
        self.assertEqual(x.nbytes, 16 * len(x))
        self.assertFalse(x.flags.owndata)
        self.assertEqual(x.strides, (16, 8))
        place = address(x)
        self.assertIs(sim["particle.position"], x)
        x[7] = [0.25, 0.75]
        del x
        again = sim["particle.position"]
        self.assertEqual(address(again), place)
        np.testing.assert_array_equal(again[7], [0.25, 0.75])

    def test_shapes(self):
        sim = minamo.Simulation(scene(), threads=1)
        n = len(sim["particle.mass"])
        self.assertEqual(sim["particle.mass"].shape, (n,))
        self.assertEqual(sim["particle.velocity"].shape, (n, 2))
        self.assertEqual(sim["particle.velocity_gradient"].shape, (n, 2, 2))
        self.assertEqual(sim["particle.id"].dtype, np.int64)
        space = minamo.Simulation(in_space(), threads=1)
        self.assertEqual(space["particle.velocity_gradient"].shape[1:], (3, 3))

    def test_row_i_of_a_gradient_is_that_of_component_i(self):
        # v = (y, 0.1): only du/dy is not zero.
        gradient = minamo.Simulation(scene(), threads=1)["particle.velocity_gradient"]
        np.testing.assert_allclose(gradient, np.broadcast_to([[0, 1], [0, 0]], gradient.shape), atol=1e-6)

    def test_arrays_outlive_the_simulation(self):
        sim = minamo.Simulation(scene(), threads=1)
        v = sim["particle.velocity"]
        part = sim["particle.position"][::2, 1]
        expected = v.copy(), part.copy()
        del sim
        gc.collect()
        np.testing.assert_array_equal(v, expected[0])
        np.testing.assert_array_equal(part, expected[1])

    def test_every_column_can_be_read(self):
        for described in (scene(), in_space(), scene(discretization={"scheme": "equal_order"})):
            sim = minamo.Simulation(described, threads=1)
            sim.step(2)
            for name in sim:
                self.assertEqual(len(sim[name]), sim[name].shape[0], name)
            self.assertGreater(len(sim.keys()), 30)


class Steps(unittest.TestCase):
    def test_an_array_keeps_its_values_when_a_step_is_taken(self):
        sim = minamo.Simulation(scene(), threads=1)
        sim.step()
        held = {name: sim[name] for name in sim}
        slices = {name: held[name][::3] for name in held}
        before = {name: array.copy() for name, array in held.items()}
        sim.step(20)
        for name, array in held.items():
            np.testing.assert_array_equal(array, before[name], name)
            np.testing.assert_array_equal(slices[name], before[name][::3], name)
            self.assertFalse(array.flags.writeable, name)
        self.assertNotEqual(address(sim["particle.position"]), address(held["particle.position"]))
        self.assertTrue((sim["particle.position"] != held["particle.position"]).any())

    def test_only_held_columns_are_copied(self):
        sim = minamo.Simulation(scene(), threads=1)
        buffers = set()
        for _ in range(12):
            buffers.add(address(sim["particle.velocity"]))
            sim.step()
        # The column's own buffers: the values, the other one of the sort, those kept for a step that is taken back.
        self.assertLessEqual(len(buffers), 3)


class Writing(unittest.TestCase):
    def test_state_can_be_written_and_nothing_else(self):
        sim = minamo.Simulation(scene(), threads=1)
        for name, column in sim.columns.items():
            array = sim[name]
            self.assertEqual(array.flags.writeable, column["writable"], name)
            self.assertEqual(column["writable"], column["lifetime"] == "state" and array.dtype == float, name)
        with self.assertRaisesRegex(ValueError, "read-only"):
            sim["particle.id"][0] = 3

    def test_what_is_written_is_what_the_step_begins_with(self):
        # A block at rest without forces stays at rest; given a velocity it moves by v dt.
        still = scene(body_force=[0, 0], walls="slip", fluid={"density": 1000, "viscosity": 0})
        still["particles"][0]["velocity"] = [0, 0]
        still["particles"][0]["shape"]["box"] = {"low": [0.25, 0.25], "high": [0.75, 0.75]}
        sim = minamo.Simulation(still, threads=1)
        sim["particle.velocity"] = [0.5, -0.25]
        sim["particle.velocity_gradient"] = 0
        x = sim["particle.position"]
        by_id = np.argsort(sim["particle.id"])
        before = x[by_id]
        sim.step()
        after = sim["particle.position"][np.argsort(sim["particle.id"])]
        np.testing.assert_allclose(after - before, np.broadcast_to([0.002, -0.001], after.shape), atol=1e-9)

    def test_an_array_from_before_the_step_does_not_take_values(self):
        sim = minamo.Simulation(scene(), threads=1)
        v = sim["particle.velocity"]
        v *= 0.5
        sim.step()
        with self.assertRaisesRegex(ValueError, "read-only"):
            v *= 0.5

    def test_what_is_not_finite_is_refused(self):
        sim = minamo.Simulation(scene(), threads=1)
        v = sim["particle.velocity"]
        v[3, 1] = np.inf
        with self.assertRaisesRegex(minamo.InputError, "particle.velocity: row 3 was set to what is not finite"):
            sim.step()
        v[3, 1] = 0
        self.assertEqual(sim.step(), 1)

    def test_a_place_outside_the_grid_is_refused(self):
        sim = minamo.Simulation(scene(), threads=1)
        sim["particle.position"][5] = [1.5, 0.5]
        with self.assertRaisesRegex(minamo.InputError, r"row 5 was set to a place outside the grid\n"
                                                       r"  expected  \[0, 0\] to \[1, 1\] m\n  got       \[1.5, 0.5\] m"):
            sim.step()
        with self.assertRaisesRegex(minamo.InputError, "outside the grid"):
            sim["particle.pressure"], sim.step()
        sim["particle.position"][5] = [1, 1]
        self.assertEqual(sim.step(), 1, "on the wall is inside")

    def test_unknown_name(self):
        sim = minamo.Simulation(scene(), threads=1)
        for kind in (KeyError, minamo.InputError):
            with self.assertRaises(kind) as raised:
                sim["particle.velocty"]
            self.assertIn('closest   "particle.velocity"', str(raised.exception))
        with self.assertRaisesRegex(minamo.InputError, "clock"):
            sim["clock"]
        self.assertNotIn("clock", sim)
        self.assertIn("particle.velocity", sim)


if __name__ == "__main__":
    unittest.main()
