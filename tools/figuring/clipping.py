"""What of closed surfaces is within the box of a run, closed again where its sides cut them."""

from __future__ import annotations

from itertools import product

import numpy as np
from matplotlib.path import Path
from matplotlib.tri import Triangulation

from reporting.bodies import chained, section


def clipped(triangles: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Triangles x 3 corners x 3 [m], the body on the inner side of each, before and after."""
    rounding = 1e-9 * (high - low).max()
    for axis, (at, inward) in product(range(3), ((low, 1), (high, -1))):
        depth = inward * (triangles[:, :, axis] - at[axis])
        if len(triangles) and depth.min() < -rounding:
            lid = _lid(triangles, axis, at[axis], inward)
            triangles = np.concatenate([_cut(triangles, depth), lid])
    return triangles


def _cut(triangles: np.ndarray, depth: np.ndarray) -> np.ndarray:
    """The parts with a depth above 0 of triangles whose corners have these depths."""
    whole, crossing = np.all(depth >= 0, axis=1), (depth.min(axis=1) < 0) & (depth.max(axis=1) > 0)
    parts = []
    for corners, depths in zip(triangles[crossing], depth[crossing]):
        polygon = []
        for k in range(3):
            here, there = depths[k], depths[(k + 1) % 3]
            if here >= 0:
                polygon.append(corners[k])
            if here * there < 0:
                polygon.append(corners[k] + here / (here - there) * (corners[(k + 1) % 3] - corners[k]))
        parts += [[polygon[0], polygon[k], polygon[k + 1]] for k in range(1, len(polygon) - 1)]
    return np.concatenate([triangles[whole], np.array(parts).reshape(-1, 3, 3)])


def _lid(triangles: np.ndarray, axis: int, at: float, inward: int) -> np.ndarray:
    """Triangles in the plane x[axis] = at where bodies go through it, that face away from `inward`."""
    first, second = (axis + 1) % 3, (axis + 2) % 3  # seen along the axis, one to the right, the other up
    loops = [loop[:, [first, second]] for loop in chained(section(triangles, axis, at))]
    if not loops:
        return np.empty((0, 3, 3))
    points = np.unique(np.concatenate(loops), axis=0)
    try:
        rows = Triangulation(*points.T).get_masked_triangles()
    except (RuntimeError, ValueError):  # a touch without an area
        return np.empty((0, 3, 3))
    within = np.logical_xor.reduce([Path(loop).contains_points(points[rows].mean(axis=1)) for loop in loops])
    lid = np.full((np.count_nonzero(within), 3, 3), at)
    lid[:, :, [first, second]] = points[rows[within]]
    return lid[:, ::-1] if inward > 0 else lid  # those of matplotlib turn to the left
