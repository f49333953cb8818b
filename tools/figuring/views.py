"""How places of a run become places in a picture, and which part of the picture plane is shown."""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import product

import numpy as np

from reporting.projection import project
from reporting.runs import NoResults, Run

AXES = "xyz"


@dataclass(frozen=True)
class View:
    """Part of the picture plane that is shown."""

    low: np.ndarray  # [m]
    high: np.ndarray  # [m]
    whole: bool  # all of the box, with its walls

    @property
    def aspect(self) -> float:
        return float((self.high[1] - self.low[1]) / (self.high[0] - self.low[0]))


@dataclass(frozen=True)
class Slice:
    """A plane across a box in 3-D; of the particles those are shown that are within half a cell of it."""

    axis: int
    at: float  # [m]

    @property
    def name(self) -> str:
        return f"{AXES[self.axis]} = {self.at:g} m"


def read_slice(text: str) -> Slice:
    """`z=0.1`; anything else is a ValueError."""
    match = re.fullmatch(r"\s*([xyz])\s*=\s*([-+0-9.eE]+)\s*", text)
    try:
        return Slice(AXES.index(match[1]), float(match[2]))
    except (TypeError, ValueError):
        raise ValueError(f"expected an axis and a place on it, like z=0.1, got \"{text}\"") from None


def check_slice(run: Run, cut: Slice) -> None:
    """Only space can be cut, and only where the box is."""
    low, high = run.box
    axis = AXES[cut.axis]
    if run.dimension == 2:
        raise NoResults(f"{run.folder}: a run in 2-D cannot be cut at {cut.name}")
    if not low[cut.axis] <= cut.at <= high[cut.axis]:
        raise NoResults(f"{run.folder}: the slice {cut.name} misses the box; expected: {axis} between "
                        f"{low[cut.axis]:g} and {high[cut.axis]:g} m")


def plane_of(run: Run, cut: Slice | None) -> tuple[int, int] | None:
    """The axes that point right and up in the picture; none if it shows space."""
    if run.dimension == 2:
        return 0, 1
    if cut is None:
        return None
    first, second = (axis for axis in range(3) if axis != cut.axis)
    return (second, first) if first == run.up else (first, second)


def place(run: Run, points: np.ndarray, cut: Slice | None) -> tuple[np.ndarray, np.ndarray]:
    """Places in the picture of the points to be drawn, and which ones these are, the farthest from the eye first."""
    plane = plane_of(run, cut)
    if plane is None:
        places, distance = project(run, points)
        order = np.argsort(-distance)
        return places[order], order
    near = np.arange(len(points)) if cut is None else np.flatnonzero(
        np.abs(points[:, cut.axis] - cut.at) <= 0.5 * run.spacing)
    return points[near][:, plane], near


def view_of(run: Run, shown: list[np.ndarray], cut: Slice | None) -> View:
    """The whole box; of a plane box without bodies whose walls nothing that is shown comes near, a part of it."""
    low, high = run.box
    plane = plane_of(run, cut)
    whole = True
    if plane is None:
        corners = project(run, np.array(list(product(*zip(low, high)))))[0]
        low, high = corners.min(axis=0), corners.max(axis=0)
    else:
        low, high = low[list(plane)], high[list(plane)]
        points = np.concatenate([np.empty((0, run.dimension)), *shown])
        if len(points) and cut is None and not run.scene.get("bodies"):
            near = 3 * run.spacing
            if np.all(points.min(axis=0) > low + near) and np.all(points.max(axis=0) < high - near):
                half = np.full(2, 1.05 * 0.5 * np.ptp(points, axis=0).max())
                middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
                low, high, whole = middle - half, middle + half, False
    margin = 0.015 * (high - low).max()
    return View(low - margin, high + margin, whole)
