"""The bodies of a run: their surfaces, and where they are at every output time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from reporting.packing import pack_table
from reporting.runs import Run


@dataclass(frozen=True)
class Body:
    """A rigid body. A point X of its surface is at position + rotation (X - pivot)."""

    name: str
    points: np.ndarray  # [m], points x dimension, where its shape is given
    elements: np.ndarray  # rows of `points`: segments of loops, or triangles; the body is to the left, or within
    pivot: np.ndarray  # [m]
    position: np.ndarray  # [m], frames x dimension
    rotation: np.ndarray  # frames x dimension x dimension
    angle: np.ndarray  # [rad], frames x 1 or 3, turned since the start

    def points_at(self, frame: int) -> np.ndarray:
        """The points of the surface. [m]"""
        return self.position[frame] + (self.points - self.pivot) @ self.rotation[frame].T

    @property
    def loops(self) -> list[np.ndarray]:
        """In 2-D: rows of `points` around each loop."""
        ends = np.flatnonzero(self.elements[1:, 0] != self.elements[:-1, 1]) + 1
        return np.split(self.elements[:, 0], ends)

    def triangles_at(self, frame: int) -> np.ndarray:
        """In 3-D: triangles x 3 corners x 3. [m]"""
        return self.points_at(frame)[self.elements]


def bodies_of(run: Run) -> list[Body]:
    """All bodies with a surface; none of a run without bodies or without frames."""
    if len(run.times) == 0:
        return []
    with run.fields() as file:
        if "bodies" not in file:
            return []
        outlines = file["bodies/outlines"]
        bodies = [_read(file, name, len(run.times)) for name in sorted(outlines)]
    return [body for body in bodies if len(body.elements)]


def _read(file, name: str, frames: int) -> Body:
    places = [file[f"bodies/{k}/{name}"] for k in range(frames)]
    outline = file[f"bodies/outlines/{name}"]
    position, rotation, angle = (np.array([place[key][:] for place in places])
                                 for key in ("position", "rotation", "angle"))
    points = outline["points"][:]
    return Body(name, points, outline["elements"][:], position[0], position, rotation, angle)


def section(triangles: np.ndarray, axis: int, at: float) -> np.ndarray:
    """Where triangles cross the plane x[axis] = at: segments x 2 ends x 3, the body to the left seen along the axis."""
    # A corner in 2-D would be on both sides of it.
    height = triangles[:, :, axis] - at
    height = np.where(height == 0, 1e-12 * (np.ptp(triangles[:, :, axis]) + 1e-300), height)
    crossing = (height.min(axis=1) < 0) & (height.max(axis=1) > 0)
    corners, height = triangles[crossing], height[crossing]
    ends = np.empty((len(corners), 2, 3))
    rows = np.arange(len(corners))
    for k in range(3):
        here, there = height[:, k], height[:, (k + 1) % 3]
        which = np.flatnonzero(here * there < 0)
        share = (here[which] / (here[which] - there[which]))[:, None]
        place = corners[which, k] + share * (corners[which, (k + 1) % 3] - corners[which, k])
        ends[rows[which], (here[which] > 0).astype(int)] = place
    return ends


def chained(segments: np.ndarray) -> list[np.ndarray]:
    """Loops of points from segments whose ends meet, in any order; what does not close is left as it is."""
    if len(segments) == 0:
        return []
    scale = 1e9 / max(float(np.abs(segments).max()), 1e-300)
    keys = [tuple(map(tuple, pair)) for pair in np.rint(segments * scale).astype(np.int64).tolist()]
    after: dict[tuple, list[int]] = {}
    for row, (start, _) in enumerate(keys):
        after.setdefault(start, []).append(row)
    loops, used = [], np.zeros(len(segments), bool)
    for first in range(len(segments)):
        row, loop = first, []
        while row is not None and not used[row]:
            used[row] = True
            loop.append(segments[row, 0])
            row = next((other for other in after.get(keys[row][1], []) if not used[other]), None)
        if len(loop) > 2:
            loops.append(np.array(loop))
    return loops


def packed_bodies(bodies: list[Body], add: Any) -> list[dict[str, Any]]:
    """What the page knows of them. `add(text)` keeps a packed column and gives the key to find it by."""
    return [{"name": body.name, "pivot": body.pivot.tolist(),
             "points": add(pack_table(list(body.points.T))), "elements": add(pack_table(list(body.elements.T))),
             "position": add(pack_table(list(body.position.T))), "angle": add(pack_table(list(body.angle.T))),
             "rotation": add(pack_table(list(body.rotation.reshape(len(body.rotation), -1).T)))} for body in bodies]
