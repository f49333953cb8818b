"""Water that comes in through sides of the box, and leaves."""

from __future__ import annotations

import numpy as np

from case import Case, Check
from checks import FINITE, SPEED, worst
from methods import METHODS_OF_BODIES
from runs import Run
from scenes import Scene, box, down, scene

N = 32
PER_CELL = 2


def imbalance(run: Run) -> float:
    """Mass that openings have not let in or out, over that of all particles: counts of particles against the history."""
    names = [opening["name"] for opening in run.scene["openings"]]
    came = sum(run.history[f"{name}_mass_in"] for name in names)
    of_particle = run.scene["fluid"]["density"] * (run.spacing / PER_CELL)**2
    there = run.history["particles"] * of_particle
    return float(np.max(np.abs(there - there[0] - came)) / np.max(there))


MASS = Check("mass", "lost count of the mass", worst(imbalance), 1e-12, "of the mass", garbage=True)


def case(name: str, what: str, openings: list[Scene], water: list[Scene] | None = None, step: float = 4e-3,
         **more: object) -> Case:
    pool = water or [box([0, 0], [1, 0.5])]
    tank = scene([N, N], 1 / N, pool, 1.0, step, body_force=down(2), openings=openings) | more
    return Case(name, "openings", what, [tank], [FINITE, SPEED, MASS], methods=METHODS_OF_BODIES)


def inflow(name: str, side: str, velocity: list[str], where: str = "1") -> Scene:
    return {"name": name, "side": side, "where": where, "inflow": {"velocity": velocity, "per_cell": PER_CELL}}


def cases() -> list[Case]:
    out = {"name": "out", "side": "x_high", "outflow": "free"}
    through = {"name": "out", "side": "x_high", "where": "y < 0.5", "outflow": {"level": 0.5}}
    stream = {"body_force": [0, 0], "walls": {"x": "slip", "y": "slip"}}
    return [
        case("tap", "a jet from above into a pool", [inflow("tap", "y_high", ["0", "-2"], "abs(x - 0.5) < 0.1")]),
        case("jet_across", "a jet from the side, faster than the fall of the pool",
             [inflow("jet", "x_low", ["4", "0"], "abs(y - 0.75) < 0.05"), out]),
        case("drain", "a pool that leaves over an open side", [out]),
        case("drain_below", "a pool that leaves through the floor",
             [{"name": "hole", "side": "y_low", "where": "abs(x - 0.5) < 0.1", "outflow": "free"}]),
        case("river", "inflow and a level downstream", [inflow("in", "x_low", ["0.5", "0"], "y < 0.5"), through]),
        case("river_thick", "the same, 1 m^2/s, no slip",
             [inflow("in", "x_low", ["0.5", "0"], "y < 0.5"), through], walls={"x": "slip", "y": ["no_slip", "slip"]},
             fluid={"density": 1000.0, "viscosity": 1000.0}),
        case("stream_cfl_4", "a stream that crosses four cells in a step", [inflow("in", "x_low", ["1", "0"]), out],
             [box([0, 0], [1, 1], velocity=[1, 0])], 0.125, **stream),
        case("pulse", "inflow that turns on and off in every step",
             [inflow("in", "x_low", ["2*max(0, sin(400*t))", "0"], "y < 0.25"), out]),
    ]
