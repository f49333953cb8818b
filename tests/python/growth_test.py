"""How fast small disturbances of water at rest grow: eigenvalues of the derivative of one step, by finite differences."""

import math
import unittest

import minamo
import numpy as np

H = 0.05  # m
CELLS = [4, 8]  # twice as wide there are twice as many disturbances, and those that grow are there as well
GRAVITY = 9.81
CHANGE = 1e-7  # in the units of each column


def pool(level, quadrature, **changes):
    """Water in a box up to a level in cells, 2 x 2 particles a cell on their lattice."""
    return {
        "dimension": 2,
        "grid": {"low": [0, 0], "high": [cells * H for cells in CELLS], "cells": CELLS},
        "fluid": {"density": 1000, "viscosity": 0},
        "body_force": [0, -GRAVITY],
        "particles": [{"shape": {"half_space": {"point": [0, level * H], "normal": [0, 1]}}, "per_cell": 2}],
        "quadrature": {"scheme": quadrature},
        "time": {"end": 1, "step": 0.012},
    } | changes


def units():
    """By name of a column what makes it of order one, and how many numbers it has."""
    return {
        "particle.position": (H, 2),
        "particle.velocity": (math.sqrt(GRAVITY * H), 2),
        "particle.velocity_gradient": (math.sqrt(GRAVITY / H), 4),
    }


def after_a_step(scene, particle=None, column=None, number=None):
    """State of all particles by id after one step, one row each, where one number of it was changed at first."""
    simulation = minamo.Simulation(scene, threads=1)
    if particle is not None:
        row = np.flatnonzero(np.array(simulation["particle.id"]) == particle)[0]
        values = np.array(simulation[column], order="C")
        values[row].reshape(-1)[number] += CHANGE * units()[column][0]
        simulation[column] = values
    simulation.step()
    order = np.argsort(np.array(simulation["particle.id"]))
    parts = [np.array(simulation[name])[order].reshape(len(order), -1) / unit for name, (unit, _) in units().items()]
    return np.concatenate(parts, axis=1).reshape(-1)


def growth_rate(scene):
    """The largest growth rate of a disturbance [1/s]."""
    ids = np.sort(np.array(minamo.Simulation(scene, threads=1)["particle.id"]))
    before = after_a_step(scene)
    derivative = [(after_a_step(scene, particle, column, number) - before) / CHANGE
                  for particle in ids for column, (_, numbers) in units().items() for number in range(numbers)]
    return math.log(np.abs(np.linalg.eigvals(np.array(derivative))).max()) / scene["time"]["step"]


class Growth(unittest.TestCase):
    """With forces that are sums over particles rest is unstable, with exact integrals it is not."""

    def test_water_on_exact_integrals_rests(self):
        for level in (4, 4.3, 4.5):
            with self.subTest(level=level):
                self.assertLess(growth_rate(pool(level, "exact")), 1e-3)

    def test_long_steps(self):
        self.assertLess(growth_rate(pool(4.5, "exact", time={"end": 1, "step": 0.024})), 1e-3)

    def test_sums_over_particles_grow(self):
        self.assertGreater(growth_rate(pool(4.5, "mixed")), 1)


if __name__ == "__main__":
    unittest.main()
