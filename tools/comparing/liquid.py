"""The misplaced area S: where only one of two runs has liquid, over the liquid of the last run."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from matplotlib.path import Path

from comparing.raster import Raster
from reporting.bodies import Body, bodies_of
from reporting.runs import Frame, NoResults, Run

SAME_TIME = 0.01  # of the shortest time between two frames


def common_frames(runs: list[Run]) -> list[list[int]]:
    """Of every time at which all runs have a frame the index in each of them."""
    gaps = [float(np.diff(run.times).min()) for run in runs if len(run.times) > 1]
    if not gaps or any(len(run.times) == 0 for run in runs):
        return []
    found = []
    for time in runs[-1].times:
        near = [int(np.argmin(np.abs(run.times - time))) for run in runs]
        if all(abs(run.times[index] - time) <= SAME_TIME * min(gaps) for run, index in zip(runs, near)):
            found.append(near)
    return found


def misplaced(runs: list[Run], frames: list[list[int]], raster: Raster) -> Iterator[tuple[float, list[float]]]:
    """By time [s], S of all runs but the last; S is not a number while the last run has no liquid."""
    bodies = [_Open(bodies_of(run) if run.dimension == 2 else [], raster) for run in runs]
    densities = [densities_of(run) for run in runs]
    for indices in frames:
        wet, liquid = [], 0.0
        for run, index, solids, density in zip(runs, indices, bodies, densities):
            frame = run.frame(index)
            volume = volumes(frame, density)
            wet.append(_wet(frame.position, volume, raster, solids.share(index)))
            liquid = float(volume.sum())
        area = raster.pixel ** len(raster.counts)
        yield frame.time, [np.count_nonzero(each != wet[-1]) * area / liquid if liquid else np.nan
                           for each in wet[:-1]]


def densities_of(run: Run) -> np.ndarray:
    """Of the liquids, in the order in which fields.h5 counts them. [kg/m^3]"""
    fluids = run.scene.get("fluids") or {"": run.scene["fluid"]}
    return np.array([float(fluid["density"]) for fluid in fluids.values()])


def volumes(frame: Frame, density: np.ndarray) -> np.ndarray:
    """Of the particles, at rest. [m^3; m^2 in 2-D]"""
    which = frame.column("fluid").astype(int) if len(density) > 1 else np.zeros(len(frame.position), int)
    return frame.column("mass") / density[which]


def _wet(position: np.ndarray, volume: np.ndarray, raster: Raster, open_share: np.ndarray) -> np.ndarray:
    """Pixels that are liquid: where it fills more than half of what bodies leave open."""
    return (open_share > 0) & (raster.fraction(position, volume) > 0.5 * open_share)


class _Open:
    """Share of the B-spline at pixels that bodies leave open; 0 inside of them."""

    def __init__(self, bodies: list[Body], raster: Raster):
        self._bodies, self._raster = bodies, raster
        self._before: int | None = None  # the frame that the share was last made for
        self._share = np.ones(raster.counts)

    def share(self, index: int) -> np.ndarray:
        """In a frame. While no body moves it stays as it is."""
        if self._bodies and (self._before is None or not self._is_as_before(index)):
            inside = np.any([inside_of(body, index, self._raster) for body in self._bodies], axis=0)
            self._share = np.where(inside, 0.0, 1 - self._raster.smooth(inside.astype(float)))
            self._before = index
        return self._share

    def _is_as_before(self, index: int) -> bool:
        return all(np.array_equal(path[index], path[self._before]) for body in self._bodies
                   for path in (body.position, body.rotation))


def inside_of(body: Body, index: int, raster: Raster) -> np.ndarray:
    """Pixels whose middle is in a body of the plane. Loops that go round clockwise are holes in it."""
    points = body.points_at(index)
    loops = [points[loop] for loop in body.loops]
    areas = [_area(loop) for loop in loops]
    # Outside of the outermost loop is the body if that loop is a hole.
    winding = np.full(raster.counts, int(max(areas, key=abs) < 0))
    for loop, area in zip(loops, areas):
        near = tuple(slice(*np.searchsorted(raster.centres(axis), (loop[:, axis].min(), loop[:, axis].max())))
                     for axis in range(2))
        x, y = np.meshgrid(raster.centres(0)[near[0]], raster.centres(1)[near[1]], indexing="ij")
        within = Path(loop).contains_points(np.column_stack([x.ravel(), y.ravel()])).reshape(x.shape)
        winding[near] += int(np.sign(area)) * within
    return winding > 0


def _area(loop: np.ndarray) -> float:
    """Positive if it goes round counterclockwise. [m^2]"""
    x, y = (loop - loop[0]).T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def why_not(runs: list[Run], raster: Raster | None, frames: list[list[int]]) -> str:
    """Why there is no misplaced area; empty if there is one."""
    if raster is None:
        return "the boxes differ"
    for run in runs:
        if len(run.times) == 0:
            return f"{run.folder} has no frames"
    if not frames:
        return "the runs have no frame at a common time"
    try:
        for run, indices in zip(runs, zip(*frames)):
            volumes(run.frame(indices[0]), densities_of(run))
    except NoResults as problem:
        return str(problem)
    return ""
