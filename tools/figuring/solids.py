"""Bodies in a panel: filled in 2-D and in slices, in 3-D lit triangles between the particles."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.patches import PathPatch, Rectangle
from matplotlib.path import Path

from figuring.clipping import clipped
from figuring.views import Slice, plane_of
from reporting.bodies import Body, bodies_of, chained, section
from reporting.projection import project
from reporting.runs import Run

FILL, EDGE = "#b9bec4", "#303030"
CELLS = 400  # of the picture that tells what is before the bodies and what behind, across

_bodies_of = lru_cache(maxsize=64)(bodies_of)  # by run: every frame asks


def has_bodies(run: Run) -> bool:
    return bool(_bodies_of(run))


def draw_flat_bodies(panel, run: Run, index: int, cut: Slice | None) -> None:
    """In 2-D: filled below the particles, their lines above. In a slice: what it cuts."""
    low, high = (end[list(plane_of(run, cut))] for end in run.box)
    box = Rectangle(low, *(high - low), transform=panel.transData)
    for body in _bodies_of(run):
        loops = _loops(run, body, index, cut)
        if not loops:
            continue
        path = Path.make_compound_path(*(Path(np.vstack([loop, loop[:1]]), closed=True) for loop in loops))
        for patch in (PathPatch(path, facecolor=FILL, edgecolor="none", zorder=0.5),
                      PathPatch(path, facecolor="none", edgecolor=EDGE, linewidth=0.8, zorder=2.5)):
            panel.add_patch(patch)
            patch.set_clip_path(box)


def _loops(run: Run, body: Body, index: int, cut: Slice | None) -> list[np.ndarray]:
    if run.dimension == 2:
        points = body.points_at(index)
        return [points[loop] for loop in body.loops]
    segments = section(body.triangles_at(index), cut.axis, cut.at)
    return chained(segments[:, :, list(plane_of(run, cut))])


def draw_solid_bodies(panel, run: Run, index: int) -> None:
    """In 3-D: triangles towards the eye, the farthest first, lit from the front."""
    places, distance, light = _seen(run, index)
    if len(places) == 0:
        return
    order = np.argsort(-distance.mean(axis=1))
    colours = np.repeat((0.35 + 0.55 * light[order])[:, None], 3, axis=1)
    panel.add_collection(PolyCollection(places[order], facecolors=colours, edgecolors=colours, linewidths=0.2,
                                        zorder=1.5))


def hidden_by_bodies(run: Run, index: int, places: np.ndarray, distance: np.ndarray) -> np.ndarray:
    """Which points of a picture in 3-D lie behind a body."""
    corners, depth, _ = _seen(run, index)
    if len(corners) == 0:
        return np.zeros(len(places), bool)
    low, high = corners.reshape(-1, 2).min(axis=0), corners.reshape(-1, 2).max(axis=0)
    size = max((high - low).max() / CELLS, 1e-300)
    nearest = _depths(corners, depth, low, size)
    cells = np.floor((places - low) / size).astype(int)
    seen = np.all((cells >= 0) & (cells < nearest.shape), axis=1)
    hidden = np.zeros(len(places), bool)
    hidden[seen] = distance[seen] > nearest[tuple(cells[seen].T)]
    return hidden


def _seen(run: Run, index: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of the triangles that face the eye: places in the picture, distances of the corners, light 0 ... 1."""
    bodies = _bodies_of(run)
    if not bodies:
        return np.empty((0, 3, 2)), np.empty((0, 3)), np.empty(0)
    corners = np.concatenate([clipped(body.triangles_at(index), *run.box) for body in bodies])
    places, distance = project(run, corners.reshape(-1, 3))
    places, distance = places.reshape(-1, 3, 2), distance.reshape(-1, 3)
    sides = np.dstack([places, -distance])  # right, up, towards the eye
    normal = np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0])
    length = np.linalg.norm(normal, axis=1)
    facing = normal[:, 2] > 1e-9 * length
    light = normal[facing] @ np.array([-0.3, 0.5, 0.8]) / length[facing]
    return places[facing], distance[facing], np.clip(light, 0, 1)


def _depths(corners: np.ndarray, depth: np.ndarray, low: np.ndarray, size: float) -> np.ndarray:
    """The distance of the nearest triangle, by cells of the picture; infinite where there is none."""
    nearest = np.full((CELLS + 1, CELLS + 1), np.inf)
    flat = (corners - low) / size
    for (a, b, c), z in zip(flat, depth):
        first = np.floor(np.minimum(np.minimum(a, b), c)).astype(int)
        last = np.minimum(np.ceil(np.maximum(np.maximum(a, b), c)).astype(int), CELLS)
        x, y = np.mgrid[first[0]:last[0] + 1, first[1]:last[1] + 1]
        turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if turn == 0:
            continue
        of_b = ((x + 0.5 - a[0]) * (c[1] - a[1]) - (y + 0.5 - a[1]) * (c[0] - a[0])) / turn
        of_c = ((b[0] - a[0]) * (y + 0.5 - a[1]) - (b[1] - a[1]) * (x + 0.5 - a[0])) / turn
        inside = (of_b > -0.05) & (of_c > -0.05) & (of_b + of_c < 1.05)
        here = np.where(inside, z[0] + of_b * (z[1] - z[0]) + of_c * (z[2] - z[0]), np.inf)
        part = nearest[first[0]:last[0] + 1, first[1]:last[1] + 1]
        np.minimum(part, here[:part.shape[0], :part.shape[1]], out=part)
    return nearest
