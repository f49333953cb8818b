"""Surfaces as they are rendered: light shows what is rough on the scale of a particle."""

from __future__ import annotations

import numpy as np

from reporting.surfaces import Surface

PAIRS = 24  # of steps; three particles are smoothed over
SHRINK, SWELL = 0.5, -0.51
DROP_POINTS, DROP_TRIANGLES = 12, 20  # of an icosahedron, which stands for a particle alone


def smooth(surface: Surface, low: np.ndarray, high: np.ndarray) -> Surface:
    """Moves points towards the mean of their neighbours and back (G. Taubin, SIGGRAPH 1995, 351): what is short is
    lost, volumes remain. Points on a wall stay on it, and drops of one particle stay as they are.

    `low` and `high` are the corners of the box. [m]"""
    points = surface.points.copy()
    drops = _drops(surface)
    triangles = surface.elements[:len(surface.elements) - DROP_TRIANGLES * drops]
    if len(triangles) == 0:
        return surface
    ends = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    degree = np.bincount(ends[:, 0], minlength=len(points))[:, None]
    near = 1e-6 * (high - low).max()
    free = (degree > 0) & (points > low + near) & (points < high - near)
    for step in PAIRS * (SHRINK, SWELL):
        sums = np.stack([np.bincount(ends[:, 0], x[ends[:, 1]], len(points)) for x in points.T], axis=1)
        points += np.where(free, step * (sums / np.maximum(degree, 1) - points), 0)
    return Surface(points, surface.elements)


def _drops(surface: Surface) -> int:
    """How many drops of one particle are behind the rest: groups of triangles that differ by the first point alone."""
    count = min(len(surface.points) // DROP_POINTS, len(surface.elements) // DROP_TRIANGLES)
    groups = surface.elements[len(surface.elements) - DROP_TRIANGLES * count:].reshape(count, 3 * DROP_TRIANGLES)
    first = len(surface.points) - DROP_POINTS * np.arange(count, 0, -1)
    from_first = groups - first[:, None]
    alike = np.all((from_first >= 0) & (from_first < DROP_POINTS), axis=1)[::-1]
    return int(alike.argmin()) if not alike.all() else count
