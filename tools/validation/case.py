"""What an experiment is: a scene, curves that were measured, figures that compare."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

Gauge = Callable[[Any], float]


@dataclass(frozen=True)
class Points:
    """A curve as points; x rises."""

    x: np.ndarray
    y: np.ndarray

    def between(self, low: float, high: float) -> Points:
        inside = (self.x >= low) & (self.x <= high)
        return Points(self.x[inside], self.y[inside])


@dataclass(frozen=True)
class Curve:
    """One measured quantity. Ours is `scale * (quantity + offset)` against `time_scale * (t - begin)`, from begin on."""

    name: str
    label: str
    ours: str | Gauge  # a column of the history, or what is measured after every step
    file: str  # of the experiment
    column: str
    scale: float = 1
    offset: float = 0
    time_column: str = "t"
    time_scale: float = 1
    begin: float = 0  # our time when the clock of the experiment begins [s]


@dataclass(frozen=True)
class Figure:
    """A number that says how far a curve is from the measured one."""

    curve: str
    what: str
    of: Callable[[Points, Points], float]  # ours, measured
    unit: str = "%"


@dataclass(frozen=True)
class Case:
    name: str
    title: str
    paper: str
    text: str  # set-up and what is known to differ
    x_label: str
    curves: tuple[Curve, ...]
    figures: tuple[Figure, ...]
    # What a picture calls a resolution, and what it sets in the scene.
    resolutions: tuple[tuple[str, dict[str, Any]], ...]
    scene: str = ""  # whose file it is; that of its own name unless given
    # Computations of others, by what a picture calls them: files next to the page with a column per curve.
    beside: tuple[tuple[str, str], ...] = ()


@dataclass
class Result:
    """A case at one resolution."""

    resolution: str
    curves: dict[str, Points]
    particles: int
    steps: int
    cpu_s: float
