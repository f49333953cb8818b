"""Runs so long that a drift would show. Those that take minutes run only with --long."""

from __future__ import annotations

from typing import Any

import numpy as np

from case import Case, Check, Scene
from checks import ALWAYS, ENERGY, worst
from methods import DEFAULT, DISCRETIZATIONS, SCHEMES, Method
from runs import Frame, Run
from scenes import box, down, scene

LAST = 10.0  # s that count as the end


def at_end(run: Run, column: str) -> np.ndarray:
    """A column of the history over the last ten seconds."""
    return run.history[column][run.history["time"] >= run.history["time"][-1] - LAST]


def frames_at_end(run: Run) -> list[Frame]:
    """Those of the last ten seconds."""
    return [frame for frame in run.frames if frame.time >= run.frames[-1].time - LAST]


def depth(run: Run) -> float:
    """That of the water once it lies still: volume over width."""
    return run.mass / run.scene["fluid"]["density"] / float(run.high[0] - run.low[0])


def level_error(run: Run) -> float:
    """Of the mean height of the surface at the end, over the depth at rest."""
    heights = [surface(run, frame) for frame in frames_at_end(run)]
    return abs(float(np.mean(heights)) / depth(run) - 1)


def surface(run: Run, frame: Frame) -> np.ndarray:
    """Its height in columns two cells wide: twice the mean height of the water in them. [m]"""
    columns = int(run.cells[0]) // 2
    along = (frame.position[:, 0] - run.low[0]) / (run.high[0] - run.low[0])
    column = np.minimum(columns * along, columns - 1).astype(int)
    mass = np.bincount(column, run.masses[frame.id], columns)
    moment = np.bincount(column, run.masses[frame.id] * (frame.position[:, 1] - run.low[1]), columns)
    return 2 * moment / np.maximum(mass, 1e-300)


def level_of_energy(run: Run, energy: np.ndarray) -> float:
    """How far the level of still water with such a potential energy is from the depth at rest, over that depth. Waves
    add to the potential energy, on average as much as their kinetic energy is, and leave the level where it is."""
    return 2 * float(np.mean(energy)) / (run.mass * -run.force[1]) / depth(run) - 1


def unrest(run: Run) -> float:
    """Mean speed at the end over sqrt(g H)."""
    square = 2 * float(np.mean(at_end(run, "kinetic_energy"))) / run.mass
    return float(np.sqrt(square / (-run.force[1] * depth(run))))


def unrest_of_cells(run: Run) -> float:
    """The same of the mean velocities of the cells, without what particles of a cell do against each other."""
    speeds = [speed_of_cells(run, frame) for frame in frames_at_end(run)]
    return float(np.mean(speeds) / np.sqrt(-run.force[1] * depth(run)))


def speed_of_cells(run: Run, frame: Frame) -> float:
    """Root of the mean square over the water. [m/s]"""
    cell = ((frame.position - run.low) / run.spacing).astype(int) @ [int(run.cells[1]) + 1, 1]
    mass = np.bincount(cell, run.masses[frame.id])
    momentum = np.array([np.bincount(cell, run.masses[frame.id] * v) for v in frame.velocity.T])
    return float(np.sqrt(np.sum(momentum**2 / np.maximum(mass, 1e-300)) / np.sum(mass)))


def share_of_standing_wave(run: Run) -> float:
    """Of the kinetic energy at the end, what the first standing wave of the tank has: by its momentum along x, from
    linear theory (H. Lamb, Hydrodynamics, 1932, art. 228), 2 rho a omega/k^2 for an amplitude a. Between slip walls it
    loses the share 4 nu k^2 of its energy per second."""
    width = float(run.high[0] - run.low[0])
    density = run.scene["fluid"]["density"]
    g = -run.force[1]
    k = np.pi / width
    omega = np.sqrt(g * k * np.tanh(k * depth(run)))
    amplitude = np.sqrt(2) * float(np.std(at_end(run, "momentum_x"))) * k**2 / (2 * density * omega)
    return float(density * g * amplitude**2 * width / 8 / np.mean(at_end(run, "kinetic_energy")))


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


def dam_break_of_the_paper(end: float, step: float, per_cell: int = 2, **more: Any) -> Scene:
    return scene([40, 40], 0.0146, [box([0, 0], [0.146, 0.292], per_cell)], end, step, body_force=[0.0, -9.81], **more)


def with_projection(schemes: tuple[str, ...]) -> list[Method]:
    return [Method(scheme, "midpoint", "projection", discretization)
            for discretization in DISCRETIZATIONS for scheme in schemes]


def minute(name: str, what: str, **more: Any) -> Case:
    """The dam break of the paper until long after its splashes."""
    return Case(
        name, "endurance", f"the dam break of the paper{what} to 60 s, steps of 2 ms, 30 000 of them",
        [dam_break_of_the_paper(60.0, 2e-3, **more)], [*ALWAYS, ENERGY, WHOLE, LEVEL, CAME_TO_REST],
        {"level by the potential energy, of the depth":
             lambda runs: level_of_energy(runs[0], at_end(runs[0], "potential_energy")),
         "the same without the energy of waves":
             lambda runs: level_of_energy(runs[0], at_end(runs[0], "potential_energy")
                                          - at_end(runs[0], "kinetic_energy")),
         "mean velocities of cells, of sqrt(g H)": lambda runs: unrest_of_cells(runs[0]),
         "share of the first standing wave in the kinetic energy": lambda runs: share_of_standing_wave(runs[0])},
        methods=with_projection(("tpic", "tpic2", "flip")),
        seconds=900, long=True)


def cases() -> list[Case]:
    steps = 1_000_000
    column = scene([8, 8], 1 / 8, [box([0, 0], [1, 0.5])], steps / 256, 1 / 256, body_force=down(2))
    drift = Check("drift", "drifted in energy", worst(energy_drift), 1e-3, "of the energy at the start")
    return [
        minute("dam_break_60_s", ""),
        # Here waves last less: between walls that hold the water they lose 43 % of their amplitude in a minute, and with
        # this viscosity half in 1.2 s.
        minute("no_slip_dam_break_60_s", " between no-slip walls", walls="no_slip"),
        minute("viscous_dam_break_60_s", " with a viscosity of 0.01 m^2/s",
               fluid={"density": 1000.0, "viscosity": 10.0}),
        # Divergence that turned over from step to step without end grew here with FLIP.
        Case("dam_break_of_16", "endurance", "the dam break of the paper, 16 particles per cell, steps of 1 ms, 5000 of them",
             [dam_break_of_the_paper(5.0, 1e-3, 4)], [*ALWAYS, ENERGY, WHOLE],
             methods=with_projection(SCHEMES), seconds=120),
        Case("column_of_a_million_steps", "endurance", "a column at rest, 8 x 8 cells, 1 000 000 steps", [column],
             [*ALWAYS, ENERGY, WHOLE, LEVEL, drift], methods=with_projection((DEFAULT.scheme,)), seconds=3600, long=True),
    ]
