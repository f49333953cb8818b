"""How far two runs of one flow are from each other: in other units, mirrored, turned."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from case import Runs
from runs import Run

Place = Callable[[np.ndarray], np.ndarray]  # where a particle of the first run should be in the second


def same_particles(first: np.ndarray, second: np.ndarray, spacing: float) -> np.ndarray:
    """Which particle of the second run starts where one of the first does."""
    def order(positions: np.ndarray) -> np.ndarray:
        return np.lexsort(np.round(positions / spacing * 1024).T)  # far finer than particles lie, far above rounding

    partner = np.empty(len(first), int)
    partner[order(first)] = order(second)
    return partner


def differences(runs: Runs, place: Place) -> np.ndarray:
    """Largest distance at every output time, in cells; the second run is where `place` has the first."""
    first, second = runs[0], runs[1]
    return distances(first, second, place, second.spacing)


def distances(first: Run, second: Run, place: Place, spacing: float) -> np.ndarray:
    if not first.frames or not second.frames:
        return np.array([np.inf])
    partner = same_particles(place(first.frames[0].position), second.frames[0].position, spacing)
    pairs = list(zip(first.frames, second.frames))
    away = [np.max(np.abs(place(a.position) - b.position[partner])) / spacing for a, b in pairs]
    return np.array(away + [np.inf] * (len(first.frames) != len(second.frames)))


def agree_until(runs: Runs, place: Place, cells: float) -> float:
    """The output time before the first at which the distance exceeds so many cells; the last if none does. [s]"""
    away = differences(runs, place)
    apart = np.flatnonzero(~(away <= cells))
    if len(apart) == 0:
        return runs[0].frames[-1].time
    return runs[0].frames[apart[0] - 1].time if 0 < apart[0] <= len(runs[0].frames) else 0.0
