"""The cost of a step on many ranks, from what few ranks compute and send."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

Measured = list[dict[str, Any]]
FACES_OF_OCTANT, FACES_INSIDE = 3, 6  # of eight ranks each is a corner of the liquid; of many nearly none
NEIGHBOURS = 26


@dataclass(frozen=True)
class Machine:
    latency: float = 2e-6    # of a message [s]
    bandwidth: float = 2e8   # of a rank, if all send [bytes/s]
    jitter: float = 0.02     # of the time between two exchanges, by which ranks differ at random
    imbalance: float = 1.15  # the fullest rank over the mean: dam breaks on eight ranks, over the run


@dataclass(frozen=True)
class Line:
    """value = at_one + slope log8(unknowns)"""

    at_one: float
    slope: float

    def __call__(self, unknowns: float) -> float:
        return self.at_one + self.slope * np.log(unknowns) / np.log(8)


@dataclass(frozen=True)
class Model:
    alone: float                # a step of one process, per particle [s]
    per_particle: float         # compute of everything but the solver [s]
    per_byte: float             # and of what is known of others, by what is sent for it [s]
    per_unknown: float          # compute of the solver [s]
    per_exchange: float         # and of what it sends [s]
    unknowns: float             # per particle
    shell: float                # bytes over particles^(2/3), all but the solver
    solver_shell: float         # of an iteration of the solver
    exchanges: float            # all but the solver
    collectives: float
    solver_exchanges: Line
    solver_collectives: Line
    iterations: Line


def line(sizes: list[float], values: list[float]) -> Line:
    slope, at_one = np.polyfit(np.log(sizes) / np.log(8), values, 1)
    return Line(at_one, slope)


def two_terms(first: list[float], second: list[float], values: list[float]) -> tuple[float, float]:
    """Factors of two terms, by least squares."""
    factors, *_ = np.linalg.lstsq(np.array([first, second]).T, values, rcond=None)
    return float(factors[0]), float(factors[1])


def fit(measured: Measured) -> Model:
    """On two ranks an exchange is one message, so that these count exchanges; and each has a core of its own here."""
    def of(series: str) -> Measured:
        return [row for row in measured if row["series"] == series]

    strong, two = of("strong"), of("two")
    dams = of("weak") + strong
    per_particle, per_byte = two_terms([row["particles"] / row["ranks"] for row in dams],
                                       [row["rest"]["bytes"] for row in dams], [row["rest"]["compute_s"] for row in dams])
    per_unknown, per_exchange = two_terms([row["unknowns"] / 2 for row in two], [row["solver"]["messages"] for row in two],
                                          [row["solver"]["compute_s"] for row in two])
    one, eight, largest = strong[0], strong[-1], two[-1]
    # Of eight ranks each has three faces to others, of two one.
    shell = FACES_INSIDE / FACES_OF_OCTANT * eight["rest"]["bytes"] / (eight["particles"] / 8) ** (2 / 3)
    solver_shell = (FACES_INSIDE * largest["solver"]["bytes"] / largest["iterations"]
                    / (largest["particles"] / 2) ** (2 / 3))
    sizes = [row["unknowns"] for row in two]
    return Model((one["rest"]["compute_s"] + one["solver"]["compute_s"]) / one["particles"], per_particle, per_byte,
                 per_unknown, per_exchange, one["unknowns"] / one["particles"], shell, solver_shell,
                 two[0]["rest"]["messages"], two[0]["rest"]["collectives"],
                 line(sizes, [row["solver"]["messages"] for row in two]),
                 line(sizes, [row["solver"]["collectives"] for row in two]),
                 line(sizes, [row["iterations"] for row in two]))


@dataclass(frozen=True)
class Step:
    """A step of a rank: compute in equal pieces, between talks of two kinds."""

    compute: float         # [s]
    exchanges: int         # with the ranks around
    exchange_bytes: float  # sent in one
    collectives: int


def steps_of(model: Model, ranks: int, particles: float) -> dict[str, Step]:
    """Of a rank with so many particles: solver and everything else."""
    if ranks == 1:
        return {"rest": Step(model.alone * particles, 0, 0, 0)}
    unknowns, face = model.unknowns * particles, particles ** (2 / 3)
    everywhere = unknowns * ranks
    shell = model.shell * face
    in_solver = model.solver_exchanges(everywhere)
    return {
        "rest": Step(model.per_particle * particles + model.per_byte * shell, round(model.exchanges),
                     shell / model.exchanges, round(model.collectives)),
        "solver": Step(model.per_unknown * unknowns + model.per_exchange * in_solver, round(in_solver),
                       model.iterations(everywhere) * model.solver_shell * face / in_solver,
                       round(model.solver_collectives(everywhere)))}


def depth(ranks: int) -> float:
    """Messages that follow one another in a sum over all ranks, and back."""
    return 2 * np.ceil(np.log2(ranks)) if ranks > 1 else 0.0


def on_paper(step: Step, machine: Machine, ranks: int) -> dict[str, float]:
    """Seconds if nobody waits."""
    return {"compute": step.compute,
            "messages": step.exchanges * NEIGHBOURS * machine.latency,
            "bytes": step.exchanges * step.exchange_bytes / machine.bandwidth,
            "collectives": step.collectives * depth(ranks) * machine.latency}


def latest_around(times: np.ndarray) -> np.ndarray:
    """Of every rank of a cube and its 26 neighbours the largest."""
    for axis in range(3):
        latest = times.copy()
        ahead, behind = [slice(None)] * 3, [slice(None)] * 3
        ahead[axis], behind[axis] = slice(1, None), slice(None, -1)
        np.maximum(latest[tuple(ahead)], times[tuple(behind)], out=latest[tuple(ahead)])
        np.maximum(latest[tuple(behind)], times[tuple(ahead)], out=latest[tuple(behind)])
        times = latest
    return times


def played(step: Step, machine: Machine, side: int, rng: np.random.Generator) -> float:
    """Seconds until the last of side^3 ranks is done, each of which waits for whom it hears from.

    Ranks have between 2 - `imbalance` and imbalance times the mean of compute, the same in the whole step; every piece of
    it takes up to `jitter` longer, at random. Collectives lie evenly between exchanges.
    """
    ranks = side ** 3
    talks = step.exchanges + step.collectives
    if ranks == 1:
        return step.compute
    pieces = step.compute / talks * rng.uniform(2 - machine.imbalance, machine.imbalance, (side, side, side))
    exchange = NEIGHBOURS * machine.latency + step.exchange_bytes / machine.bandwidth
    time = np.zeros((side, side, side))
    collectives = 0
    for talk in range(talks):
        time += pieces * (1 + machine.jitter * rng.random((side, side, side)))
        if collectives * talks < step.collectives * (talk + 1):
            collectives += 1
            time[:] = time.max() + depth(ranks) * machine.latency
        else:
            time = latest_around(time) + exchange
    return float(time.max())

