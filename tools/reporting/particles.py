"""The particles of a run for the page: which quantities there are, their ranges, all frames packed."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from reporting.packing import Packed, pack_frames, pack_table
from reporting.rows import Rows, stays_of
from reporting.runs import Run

AXES = "xyz"
UNITS = {"velocity": "m/s", "pressure": "Pa", "velocity_gradient": "1/s"}
COARSE_BITS = 10  # of a quantity where there are many particles: four times as many shades as colours
MANY = 1 << 20  # particles times frames


@dataclass
class Quantity:
    """What particles can be coloured by."""

    name: str
    unit: str
    signed: bool = False  # zero is the middle of its colours
    classes: tuple[str, ...] = ()  # what 0, 1, ... stand for, where a number is no size
    low: float = np.inf  # over all particles and frames
    high: float = -np.inf
    shown: list[np.ndarray] = field(default_factory=list)  # by frame, of the particles in the page

    def add(self, values: np.ndarray, chosen: np.ndarray) -> None:
        """Takes up the next frame; `chosen` are the places of the page's particles in it."""
        finite = values[np.isfinite(values)]
        if len(finite):
            self.low, self.high = min(self.low, float(finite.min())), max(self.high, float(finite.max()))
        self.shown.append(values[chosen].astype(np.float32))

    def packed(self, bits: int, rows: list[np.ndarray], count: int) -> tuple[dict[str, Any], Packed]:
        """What the page knows of it, and its codes; `rows` are those of the page's particles, by frame, of `count`."""
        values = in_rows(self.shown, rows, count)
        finite = values[np.isfinite(values)]
        usual = np.percentile(finite, [0.5, 99.5]).tolist() if len(finite) else [0.0, 0.0]
        low, high = self._coded_range(*usual)
        described = {"name": self.name, "unit": self.unit, "signed": self.signed, "low": low, "high": high,
                     "bits": bits, "usual": usual, "least": _finite(self.low), "most": _finite(self.high)}
        if self.classes:
            described["classes"] = list(self.classes)
        return described, pack_frames(values, low, high, bits, 1)

    def _coded_range(self, low: float, high: float) -> tuple[float, float]:
        """The whole range, unless a few wild particles would leave all others a handful of codes."""
        reach = 30 * max(high - low, 1e-12 * max(abs(low), abs(high)))
        return max(_finite(self.low), low - reach), min(_finite(self.high), high + reach)


def quantities(columns: dict[str, np.ndarray], dimension: int) -> dict[str, tuple[np.ndarray, str, bool]]:
    """Scalars of a frame by name: values, unit, whether both signs matter. All that fields.h5 holds is
    here, but for what no particle changes."""
    found: dict[str, tuple[np.ndarray, str, bool]] = {}
    for name, values in columns.items():
        if name in ("id", "mass", "position", "volume"):
            continue
        unit, words = UNITS.get(name, ""), name.replace("_", " ")
        if values.ndim == 1:
            found[words] = values, unit, False
            continue
        size = np.linalg.norm(values, axis=1)
        found["speed" if name == "velocity" else f"{words}, norm"] = size, unit, False
        if values.shape[1] == dimension:
            found |= {f"{words} {AXES[d]}": (values[:, d], unit, True) for d in range(dimension)}
        elif name == "velocity_gradient":
            found |= _of_gradient(values.reshape(-1, dimension, dimension), unit)
    first = [name for name in ("fluid", "speed", "pressure") if name in found]
    return {name: found[name] for name in first + [name for name in found if name not in first]}


def _of_gradient(gradient: np.ndarray, unit: str) -> dict[str, tuple[np.ndarray, str, bool]]:
    """Rotation and divergence; gradient[p, i, j] = dv_i/dx_j."""
    pairs = [(i, j) for i, j in ((0, 1), (1, 2), (2, 0)) if max(i, j) < gradient.shape[1]]
    turning = [gradient[:, j, i] - gradient[:, i, j] for i, j in pairs]
    vorticity = (turning[0], unit, True) if len(turning) == 1 else (np.linalg.norm(turning, axis=0), unit, False)
    return {"vorticity": vorticity, "divergence": (np.trace(gradient, axis1=1, axis2=2), unit, True)}


@dataclass(frozen=True)
class Particles:
    """All frames of a run, those particles that a page has room for."""

    counts: list[int]  # in the run, by frame
    share: float  # of all particles, that are in the page [1]
    rows: list[np.ndarray]  # of the page's particles, by frame
    ids: np.ndarray  # frames x rows; -1 where nobody is
    position: np.ndarray  # [m], frames x rows x dimension
    quantities: list[Quantity]

    @classmethod
    def read(cls, run: Run, most: int) -> Particles | None:
        """About `most` particles at a time, drawn by chance, always the same ones; None if no frame is written yet."""
        if len(run.times) == 0:
            return None
        ids = [run.ids(index) for index in range(len(run.times))]
        counts = [len(each) for each in ids]
        share = min(1.0, most / max(counts))
        chosen = _chosen(ids, share)
        used, rows, places, found = Rows(), [], [], {}
        for index, numbers in enumerate(ids):
            columns, here = run.columns(index), np.flatnonzero(chosen[numbers])
            rows.append(used.of(numbers[here]))
            places.append(columns["position"][here])
            for name, (values, unit, signed) in quantities(columns, run.dimension).items():
                classes = run.fluids if name == "fluid" else ()
                found.setdefault(name, Quantity(name, unit, signed, classes)).add(values, here)
        shown = in_rows([each[chosen[each]] for each in ids], rows, used.count, nobody=-1)
        return cls(counts, share, rows, shown, in_rows(places, rows, used.count), list(found.values()))

    @property
    def changes(self) -> bool:
        """Whether particles come or go."""
        return bool(np.any(self.ids != self.ids[0]))

    @property
    def reach(self) -> tuple[np.ndarray, np.ndarray]:
        """Low and high corner of all places at all times. [m]"""
        places = self.position[self.ids >= 0]
        return places.min(axis=0), places.max(axis=0)

    def packed(self, add: Any) -> dict[str, Any]:
        """What the page knows of them. `add(text)` keeps a packed column and gives the key to find it by."""
        frames, rows, dimension = self.position.shape
        axes = [self._axis(d) for d in range(dimension)]
        bits = COARSE_BITS if frames * rows > MANY else 16
        fields = [quantity.packed(bits, self.rows, rows) for quantity in self.quantities]
        return {
            "counts": self.counts, "share": self.share, "rows": rows, "changes": self.changes,
            "stays": add(pack_table(stays_of(self.ids))),
            "position": {"low": [axis.low for axis in axes], "high": [axis.high for axis in axes],
                         "step": max(axis.step for axis in axes), "keys": [add(axis.text) for axis in axes]},
            "fields": [described | {"key": add(packed.text)} for described, packed in fields],
        }

    def _axis(self, axis: int) -> Packed:
        values = self.position[:, :, axis]
        finite = values[np.isfinite(values)]
        low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 1.0)
        return pack_frames(values, low, high, 16, 2)


def _chosen(ids: list[np.ndarray], share: float) -> np.ndarray:
    """Whether a particle is in the page, by its id: a share of all that are in a frame, drawn by chance."""
    seen = np.zeros(max(int(each.max(initial=0)) for each in ids) + 1, bool)
    for each in ids:
        seen[each] = True
    everyone, chosen = np.flatnonzero(seen), np.zeros_like(seen)
    chosen[np.random.default_rng(1).choice(everyone, round(share * len(everyone)), replace=False)] = True
    return chosen


def in_rows(values: list[np.ndarray], rows: list[np.ndarray], count: int, nobody: float = np.nan) -> np.ndarray:
    """Values by frame, each in its row of `count`; `nobody` in the others."""
    found = np.full((len(values), count, *values[0].shape[1:]), nobody, values[0].dtype)
    for frame, own, of in zip(found, values, rows):
        frame[of] = own
    return found


def _finite(value: float) -> float:
    return value if np.isfinite(value) else 0.0
