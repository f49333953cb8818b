"""All that is told of some runs compared with the last of them. Nothing is printed or drawn here."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from comparing.checks import chosen_columns, common_end, require_alike
from comparing.convergence import Figure, figures_of, refinement
from comparing.histories import Difference, difference
from comparing.liquid import common_frames, misplaced, why_not
from comparing.raster import Raster, common_raster
from reporting.runs import NoResults, Run


@dataclass(frozen=True)
class Misplaced:
    """The misplaced area S at the common frames."""

    times: np.ndarray  # [s]
    shares: np.ndarray  # times x runs but the last
    raster: Raster


@dataclass(frozen=True)
class Comparison:
    """Of runs, each with the last one."""

    runs: list[Run]
    columns: list[str]
    end: float  # of the common time [s]
    at: float | None  # time of the figures and of the particles, if it was chosen [s]
    differences: list[list[Difference]]  # by run but the last, by column
    frames: list[list[int]]  # common ones, the index in each run
    liquid: Misplaced | None
    no_liquid: str  # why there is none
    figures: list[Figure]  # of three grids

    @property
    def last(self) -> Run:
        return self.runs[-1]

    @property
    def shown_frame(self) -> list[int] | None:
        """The common frame nearest to the chosen time, else the last one."""
        if not self.frames:
            return None
        times = np.array([self.last.times[indices[-1]] for indices in self.frames])
        return self.frames[-1 if self.at is None else int(np.argmin(np.abs(times - self.at)))]


def compare(runs: list[Run], wanted: list[str] | None, at: float | None) -> Comparison:
    """NoResults if the runs have nothing to compare."""
    require_alike(runs)
    end = common_end(runs)
    if at is not None and not 0 <= at <= end:
        raise NoResults(f"t = {at:g} s is outside the common time of the runs; expected: between 0 and {end:.6g} s")
    columns = chosen_columns(runs, wanted)
    differences = [[difference(run, runs[-1], column, end) for column in columns] for run in runs[:-1]]
    frames, raster = common_frames(runs), common_raster(runs)
    reason = why_not(runs, raster, frames)
    liquid = None if reason else _liquid(runs, frames, raster)
    series = refinement(runs)
    figures = figures_of(*series, columns, end, at) if series else []
    return Comparison(runs, columns, end, at, differences, frames, liquid, reason, figures)


def _liquid(runs: list[Run], frames: list[list[int]], raster: Raster) -> Misplaced:
    times, shares = zip(*misplaced(runs, frames, raster))
    return Misplaced(np.array(times), np.array(shares), raster)
