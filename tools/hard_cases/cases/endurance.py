"""Runs so long that a drift would show. They take minutes and run only with --long."""

from __future__ import annotations

import numpy as np

from case import Case, Check, Scene
from checks import ALWAYS, ENERGY, worst
from methods import DEFAULT, Method
from runs import Run
from scenes import box, down, scene

LAST = 10.0  # s that count as the end


def level_error(run: Run) -> float:
    """Mean level of the last ten seconds, from the potential energy, against the volume over the width."""
    late = run.history["time"] >= run.history["time"][-1] - LAST
    g = -run.force[1]
    level = 2 * float(np.mean(run.history["potential_energy"][late])) / (run.mass * g)
    exact = run.mass / run.scene["fluid"]["density"] / float(run.high[0] - run.low[0])
    return abs(level - exact) / exact


def level_below_waves(run: Run) -> float:
    """The same, signed, with the potential energy that waves have, which is as much as their kinetic energy, taken off."""
    late = run.history["time"] >= run.history["time"][-1] - LAST
    energy = float(np.mean((run.history["potential_energy"] - run.history["kinetic_energy"])[late]))
    level = 2 * energy / (run.mass * -run.force[1])
    return level / (run.mass / run.scene["fluid"]["density"] / float(run.high[0] - run.low[0])) - 1


def unrest(run: Run) -> float:
    """Mean speed at the end over sqrt(g H)."""
    depth = run.mass / run.scene["fluid"]["density"] / float(run.high[0] - run.low[0])
    late = run.history["time"] >= run.history["time"][-1] - LAST
    square = 2 * float(np.mean(run.history["kinetic_energy"][late])) / run.mass
    return float(np.sqrt(square / (-run.force[1] * depth)))


def share_of_standing_wave(run: Run) -> float:
    """Of the kinetic energy at the end, what the first standing wave of the tank has: by its momentum along x, from
    linear theory (H. Lamb, Hydrodynamics, 1932, art. 228), 2 rho a omega/k^2 for an amplitude a. Between slip walls it
    loses the share 4 nu k^2 of its energy per second."""
    width = float(run.high[0] - run.low[0])
    density = run.scene["fluid"]["density"]
    g = -run.force[1]
    k = np.pi / width
    omega = np.sqrt(g * k * np.tanh(k * run.mass / density / width))
    late = run.history["time"] >= run.history["time"][-1] - LAST
    momentum = run.history["momentum_x"][late]
    amplitude = np.sqrt(2) * float(np.std(momentum)) * k**2 / (2 * density * omega)
    return float(density * g * amplitude**2 * width / 8 / np.mean(run.history["kinetic_energy"][late]))


def energy_drift(run: Run) -> float:
    """Largest change of the energy after the first hundredth of the run, over the energy at the start."""
    later = run.energy[len(run.energy) // 100:]
    return float(np.max(np.abs(later - later[0]))) / float(run.energy[0])


def unfinished(run: Run) -> float:
    """Share of the time that was not reached."""
    return 1 - float(run.history["time"][-1]) / run.scene["time"]["end"]


LEVEL = Check("level", "ended at a wrong level", worst(level_error), 0.01, "of the depth")
CAME_TO_REST = Check("rest", "did not come to rest", worst(unrest), 0.01, "of sqrt(g H)")
WHOLE = Check("whole", "did not reach the end", worst(unfinished), 1e-9, "of the time")


def dam_break_60(step: float = 2e-3) -> Scene:
    return scene([40, 40], 0.0146, [box([0, 0], [0.146, 0.292])], 60.0, step, body_force=[0.0, -9.81])


def cases() -> list[Case]:
    steps = 1_000_000
    column = scene([8, 8], 1 / 8, [box([0, 0], [1, 0.5])], steps / 256, 1 / 256, body_force=down(2))
    drift = Check("drift", "drifted in energy", worst(energy_drift), 1e-3, "of the energy at the start")
    return [
        Case("dam_break_60_s", "endurance", "the dam break of the paper to 60 s, steps of 2 ms, 30 000 of them",
             [dam_break_60()], [*ALWAYS, ENERGY, WHOLE, LEVEL, CAME_TO_REST],
             {"level without the energy of waves, of the depth": lambda runs: level_below_waves(runs[0]),
              "share of the first standing wave in the kinetic energy": lambda runs: share_of_standing_wave(runs[0])},
             methods=[Method(scheme, "midpoint", "projection") for scheme in ("tpic", "flip")], seconds=900, long=True),
        Case("column_of_a_million_steps", "endurance", "a column at rest, 8 x 8 cells, 1 000 000 steps", [column],
             [*ALWAYS, ENERGY, WHOLE, LEVEL, drift], methods=[DEFAULT], seconds=3600, long=True),
    ]
