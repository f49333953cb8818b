"""Which part of the plane a picture shows, and how space comes into it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from reporting.runs import Run


@dataclass(frozen=True)
class View:
    """Part of the picture plane that is shown."""

    low: np.ndarray
    high: np.ndarray

    @property
    def aspect(self) -> float:
        return float((self.high[1] - self.low[1]) / (self.high[0] - self.low[0]))


def view_of(run: Run, shown: list[np.ndarray]) -> View:
    """The whole box; of a plane box whose walls nothing that is shown comes near, the part with what is shown."""
    low, high = run.box
    if run.dimension == 3:
        corners = project(run, np.array(list(product(*zip(low, high)))))[0]
        low, high = corners.min(axis=0), corners.max(axis=0)
    elif shown:
        points = np.concatenate(shown)
        near = 3 * run.spacing
        if np.all(points.min(axis=0) > low + near) and np.all(points.max(axis=0) < high - near):
            half = np.full(2, 1.05 * 0.5 * np.ptp(points, axis=0).max())
            middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
            low, high = middle - half, middle + half
    margin = 0.015 * (high - low).max()
    return View(low - margin, high + margin)


def project(run: Run, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Parallel projection of points in space, seen from the front, a little from the right and above.

    Returns the place in the picture and the distance from the eye.
    """
    turn, tilt = np.radians(25), np.radians(22)
    rightward, upward = np.eye(3)[0 if run.up != 0 else 1], np.eye(3)[run.up]
    right, into, up = points @ rightward, points @ np.cross(upward, rightward), points @ upward
    across, away = np.cos(turn) * right + np.sin(turn) * into, np.cos(turn) * into - np.sin(turn) * right
    return np.column_stack([across, np.cos(tilt) * up + np.sin(tilt) * away]), np.cos(tilt) * away - np.sin(tilt) * up
