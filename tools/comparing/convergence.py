"""Order of convergence, extrapolated value and grid convergence index of a figure on three grids.

P. J. Roache, Journal of Fluids Engineering 116 (1994) 405; I. B. Celik et al., Journal of Fluids Engineering 130 (2008)
078001, whose factor of safety is 1.25.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from comparing.histories import samples
from reporting.facts import differing_keys
from reporting.runs import Run

SAFETY = 1.25
SAME = 1e-12  # of a value: rounding
USUAL = (0.5, 3.0)  # orders between which an error is likely to fall like a power of the spacing


@dataclass(frozen=True)
class Figure:
    """A number that a history gives on the coarse, the middle and the fine grid."""

    column: str
    kind: str  # "at the end", "at T s", "maximum" or "minimum"
    values: tuple[float, float, float]
    ratio: float  # of the spacings of two grids

    @property
    def convergence(self) -> str:
        """monotone, or why there is no order."""
        coarse, middle, fine = self.values
        before, after = coarse - middle, middle - fine
        small = SAME * max(map(abs, self.values))
        if not np.all(np.isfinite(self.values)):
            return "not known on all grids"
        if abs(before) <= small and abs(after) <= small:
            return "the same on all grids"
        if abs(before) <= small or before * after <= 0:
            return "not monotone: an order means nothing"
        return "monotone" if abs(after) < abs(before) else "differences grow: an order means nothing"

    @property
    def order(self) -> float:
        """Observed, p = ln((f3 - f2) / (f2 - f1)) / ln r, f1 on the fine grid."""
        coarse, middle, fine = self.values
        return float(np.log((coarse - middle) / (middle - fine)) / np.log(self.ratio))

    @property
    def is_usual(self) -> bool:
        """Whether the order is one that the method may have."""
        return USUAL[0] <= self.order <= USUAL[1]

    @property
    def extrapolated(self) -> float:
        """By Richardson, f1 + (f1 - f2) / (r^p - 1)."""
        _, middle, fine = self.values
        return fine + (fine - middle) / (self.ratio**self.order - 1)

    @property
    def index(self) -> float:
        """Grid convergence index of the fine grid, 1.25 |(f1 - f2) / f1| / (r^p - 1)."""
        _, middle, fine = self.values
        return SAFETY * abs((fine - middle) / fine) / (self.ratio**self.order - 1) if fine else np.nan


def refinement(runs: list[Run]) -> tuple[list[Run], float] | None:
    """Three runs from coarse to fine and the ratio of their spacings; None if they are no such series."""
    if len(runs) != 3 or [row[0] for row in differing_keys(runs)] != ["/grid/cells"]:
        return None
    series = sorted(runs, key=lambda run: -run.spacing)
    cells = np.array([run.scene["grid"]["cells"] for run in series], float)
    ratios = cells[1:] / cells[:-1]
    ratio = float(ratios[0, 0])
    return (series, ratio) if ratio > 1 and np.allclose(ratios, ratio, rtol=1e-6) else None


def figures_of(series: list[Run], ratio: float, columns: list[str], end: float, at: float | None) -> list[Figure]:
    """Of every column the value at a time, by default the end of the common time, and the largest one up to the end, or
    the smallest of what is nowhere above zero."""
    found = []
    for column in columns:
        histories = [samples(run, column, end) for run in series]
        if any(len(times) == 0 for times, _ in histories):
            continue
        time, kind = (end, "at the end") if at is None else (at, f"at {at:g} s")
        found.append(Figure(column, kind, tuple(float(np.interp(time, *history)) for history in histories), ratio))
        is_above = any(values.max() > 0 for _, values in histories)
        extremes = tuple(float(values.max() if is_above else values.min()) for _, values in histories)
        found.append(Figure(column, "maximum" if is_above else "minimum", extremes, ratio))
    return found
