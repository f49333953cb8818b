"""The volume fraction of the liquid on a raster, from particles, as tools/compare_interfoam.py has it.

sum_p V_p N((x - x_p)/h) N((y - y_p)/h) / h^2, N the quadratic B-spline, mirrored at the walls, h the same for all runs.
Particles are shared out to the nearest pixels first, linearly, which widens N by less than a hundredth.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from compare_interfoam import b_spline
from reporting.overlays import walls
from reporting.runs import Run

FINEST = 10  # pixels per width of the B-spline
MOST_PIXELS = 1_000_000


@dataclass(frozen=True)
class Raster:
    """Pixels of the box."""

    low: np.ndarray  # corner of the box [m]
    pixel: float  # [m]
    counts: tuple[int, ...]  # along each axis
    width: float  # of the B-spline [m]
    periodic: tuple[bool, ...]

    def centres(self, axis: int) -> np.ndarray:
        """[m]"""
        return self.low[axis] + self.pixel * (np.arange(self.counts[axis]) + 0.5)

    def fraction(self, position: np.ndarray, volume: np.ndarray) -> np.ndarray:
        """Share of every pixel's surroundings that is liquid."""
        return self.smooth(self._shared_out(position, volume)) / self.pixel ** len(self.counts)

    def smooth(self, values: np.ndarray) -> np.ndarray:
        """Convolved with the B-spline along every axis."""
        reach = int(np.ceil(1.5 * self.width / self.pixel))
        weights = b_spline(np.arange(-reach, reach + 1) * self.pixel / self.width)
        weights /= weights.sum()
        for axis, periodic in enumerate(self.periodic):
            wide = np.pad(values, [(reach, reach) if k == axis else (0, 0) for k in range(values.ndim)],
                          mode="wrap" if periodic else "symmetric")
            along = np.moveaxis(wide, axis, 0)
            count = self.counts[axis]
            values = np.moveaxis(sum(w * along[k:k + count] for k, w in enumerate(weights)), 0, axis)
        return values

    def _shared_out(self, position: np.ndarray, volume: np.ndarray) -> np.ndarray:
        place = (position - self.low) / self.pixel - 0.5
        base = np.floor(place).astype(int)
        share = place - base
        total = np.zeros(int(np.prod(self.counts)))
        for corner in product((0, 1), repeat=len(self.counts)):
            weight, index = volume.copy(), np.zeros(len(volume), int)
            for axis, (up, count) in enumerate(zip(corner, self.counts)):
                weight = weight * (share[:, axis] if up else 1 - share[:, axis])
                k = base[:, axis] + up
                k = k % count if self.periodic[axis] else np.clip(np.where(k < 0, -1 - k, k), 0, count - 1)
                index = index * count + k
            total += np.bincount(index, weight, len(total))
        return total.reshape(self.counts)


def common_raster(runs: list[Run]) -> Raster | None:
    """As wide a B-spline as the widest cell; none for runs whose boxes differ."""
    last = runs[-1]
    low, high = last.box
    if not all(np.allclose(end, other) for run in runs for end, other in zip(run.box, (low, high))):
        return None
    width = max(run.spacing for run in runs)
    per_width = FINEST
    while per_width > 2 and np.prod((high - low) / width * per_width) > MOST_PIXELS:
        per_width -= 1
    counts = tuple(int(count) for count in np.maximum(1, np.rint((high - low) / width * per_width)))
    periodic = tuple("periodic" in sides for sides in walls(last.scene.get("walls", "slip"), last.dimension))
    return Raster(low, float((high[0] - low[0]) / counts[0]), counts, width, periodic)
