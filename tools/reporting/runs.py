"""The results of a run: scene.json, summary.json, history.csv and the frames of fields.h5. Nothing is drawn here."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

# Before HDF5 is loaded: who reads with a lock makes a run fail that wants to write its next frame meanwhile.
os.environ["HDF5_USE_FILE_LOCKING"] = "FALSE"

import h5py
import numpy as np


class NoResults(Exception):
    """A folder does not hold what is wanted of it."""


@dataclass(frozen=True)
class Frame:
    """The particles at an output time, in the order of their ids."""

    time: float  # [s]
    columns: dict[str, np.ndarray]
    source: str  # for messages

    def column(self, name: str) -> np.ndarray:
        """A field, which a run may have left out."""
        if name not in self.columns:
            raise NoResults(f"{self.source} has no {name}; expected: a run with \"{name}\" in /output/fields")
        return self.columns[name]

    @property
    def id(self) -> np.ndarray:
        return self.column("id")

    @property
    def position(self) -> np.ndarray:
        """Particles x dimension. [m]"""
        return self.column("position")

    @property
    def velocity(self) -> np.ndarray:
        """Particles x dimension. [m/s]"""
        return self.column("velocity")


class Run:
    """A folder with results. What a run that failed or still goes on has not written yet is empty."""

    def __init__(self, folder: str | Path):
        self.folder = Path(folder)
        if not (self.folder / "scene.json").is_file():
            raise NoResults(f"{folder}: no results of minamo here (no scene.json); "
                            "expected: a folder that `minamo run SCENE --out DIR` wrote")
        self.problems: list[str] = []  # of files that are there and cannot be read
        self.scene = self._json("scene.json")
        liquid = "fluids" if "fluids" in self.scene else "fluid"
        missing = [key for key in ("dimension", "grid", liquid, "particles", "time") if key not in self.scene]
        if missing:
            raise NoResults(f"{self.folder}/scene.json: no /{missing[0]}; expected: the scene that "
                            "`minamo run SCENE --out DIR` wrote")
        self.summary = self._json("summary.json")
        self.history = self._history()
        self.units: dict[str, str] = self._json("history.units.json")  # of the columns of the history
        self.times = self._times()

    def require_whole(self) -> None:
        """NoResults if a file is there that cannot be read."""
        if self.problems:
            raise NoResults("\n".join(self.problems))

    def _json(self, name: str) -> dict[str, Any]:
        path = self.folder / name
        try:
            return json.loads(path.read_text()) if path.is_file() else {}
        except json.JSONDecodeError as error:
            raise NoResults(f"{path}: cannot be read as JSON ({error}); expected: what `minamo run --out DIR` wrote"
                            ) from error

    def _history(self) -> dict[str, np.ndarray]:
        path = self.folder / "history.csv"
        # The last row may be half written while the run goes on, within a number, too.
        lines = path.read_text().rpartition("\n")[0].splitlines() if path.is_file() else []
        if not lines:
            return {}
        header, *rows = lines
        names = header.split(",")
        cells = [row.split(",") for row in rows if row.count(",") == len(names) - 1]
        values = np.array([[float(cell or "nan") for cell in row] for row in cells]).reshape(-1, len(names))
        return dict(zip(names, values.T))

    @contextmanager
    def fields(self) -> Iterator[h5py.File]:
        """fields.h5, open for reading. What goes wrong meanwhile, as while a run writes it, is a NoResults."""
        try:
            with h5py.File(self.folder / "fields.h5", "r") as file:
                yield file
        except (OSError, KeyError, RuntimeError) as error:
            hint = "" if self.summary else "; a run that goes on may be writing it: try again"
            raise NoResults(f"{self.folder}: fields.h5 cannot be read ({error}){hint}") from error

    def _times(self) -> np.ndarray:
        if not (self.folder / "fields.h5").is_file():
            return np.empty(0)
        try:
            with self.fields() as file:
                particles = file.get("particles", {})
                return np.array([float(particles[key].attrs["time"]) for key in sorted(particles, key=int)])
        except NoResults as problem:
            self.problems.append(str(problem))
            return np.empty(0)

    def ids(self, index: int) -> np.ndarray:
        """Who is there in frame `index` of fields.h5, ascending. Nobody gets the id of one who has left."""
        with self.fields() as file:
            return np.sort(file[f"particles/{index}/id"][:])

    @cached_property
    def field_names(self) -> set[str]:
        """What all frames hold: a run that goes on may write more or less than before."""
        with self.fields() as file:
            return set.intersection(*(set(group) for group in file["particles"].values()))

    def columns(self, index: int) -> dict[str, np.ndarray]:
        """Of frame `index` of fields.h5 what all frames hold, particles x width or particles, in the order of the ids.
        Vectors and tensors have the dimension of the scene, real numbers are double, however they are stored."""
        with self.fields() as file:
            group = file[f"particles/{index}"]
            order = np.argsort(group["id"][:])
            return {name: as_computed(values[:][order], self.dimension) for name, values in group.items()
                    if name in self.field_names}

    def frame(self, index: int) -> Frame:
        """Frame `index` of fields.h5."""
        return Frame(float(self.times[index]), self.columns(index), f"{self.folder}: fields.h5")

    def frames(self) -> Iterator[Frame]:
        """All frames, in the order of time."""
        return (self.frame(index) for index in range(len(self.times)))

    def frame_at(self, time: float, tolerance: float) -> Frame | None:
        """The frame nearest to a time, if it is within the tolerance. [s]"""
        if len(self.times) == 0:
            return None
        index = int(np.argmin(np.abs(self.times - time)))
        return self.frame(index) if abs(self.times[index] - time) <= tolerance else None

    def series(self, column: str) -> np.ndarray | None:
        """A column of the history; the sum of the energies is made here."""
        if column == "total_energy":
            parts = [self.history.get(name) for name in ("kinetic_energy", "potential_energy")]
            return None if any(part is None for part in parts) else parts[0] + parts[1]
        return self.history.get(column)

    @property
    def name(self) -> str:
        """Name of the folder."""
        return self.folder.resolve().name

    @property
    def title(self) -> str:
        """Title of the scene, or the name of the folder."""
        return self.scene.get("title") or self.name

    @property
    def fluids(self) -> tuple[str, ...]:
        """Names of the liquids, as the column fluid of fields.h5 counts them; none where there is one without a name."""
        return tuple(self.scene.get("fluids", {}))

    @property
    def scheme(self) -> str:
        """Transfer scheme, as it is written in papers."""
        return self.scene.get("transfer", {}).get("scheme", "tpic2").upper()

    @property
    def status(self) -> str:
        """done, failed, interrupted, or that there is no end yet."""
        return self.summary.get("status", "not finished")

    @property
    def dimension(self) -> int:
        return int(self.scene["dimension"])

    @property
    def box(self) -> tuple[np.ndarray, np.ndarray]:
        """Low and high corner of the grid. [m]"""
        grid = self.scene["grid"]
        return np.array(grid["low"], float), np.array(grid["high"], float)

    @property
    def spacing(self) -> float:
        """Of the grid. [m]"""
        low, high = self.box
        return float((high[0] - low[0]) / self.scene["grid"]["cells"][0])

    @property
    def per_cell(self) -> int:
        """Particles per cell and direction: the most of those at the start and those that come in."""
        flows = [flow for opening in self.scene.get("openings", []) for flow in opening.values()
                 if isinstance(flow, dict)]
        return max(region.get("per_cell", 3) for region in self.scene["particles"] + flows)

    @property
    def particle_size(self) -> float:
        """Distance of the particles at the start. [m]"""
        return self.spacing / self.per_cell

    @property
    def up(self) -> int:
        """The axis against the body force; the last one if there is none."""
        force = [entry if isinstance(entry, (int, float)) else 0 for entry in self.scene.get("body_force", [])]
        return int(np.argmax(np.abs(force))) if any(force) else self.dimension - 1


def as_computed(values: np.ndarray, dimension: int) -> np.ndarray:
    """A column in double precision, and in 2-D without what is zero there: the third component of a vector, the
    third row and column of a tensor."""
    if values.dtype.kind == "f":
        values = values.astype(float)
    if values.ndim == 2 and dimension == 2 and values.shape[1] in (3, 9):
        return values[:, [0, 1] if values.shape[1] == 3 else [0, 1, 3, 4]]
    return values


def labels(runs: list[Run]) -> list[str]:
    """What tells the runs apart in a few letters: the scheme, else the title, else the folder."""
    for names in ([run.scheme for run in runs], [run.title for run in runs], [run.name for run in runs]):
        if len(set(names)) == len(runs):
            return names
    return [str(run.folder) for run in runs]


def telling_times(run: Run, count: int) -> list[float]:
    """Output times between which the particles move about equally far, first and last among them. [s]"""
    if len(run.times) <= count:
        return list(run.times)
    moved, before = [0.0], None
    for frame in run.frames():
        if before is not None:
            moved.append(moved[-1] + _way(before, frame))
        before = frame
    way = np.array(moved) + 1e-9 * (moved[-1] or 1) * np.arange(len(moved))  # grows even where nothing moves
    chosen = [0]
    for k, wanted in enumerate(np.linspace(way[0], way[-1], count)[1:], start=1):
        nearest = int(np.argmin(np.abs(way - wanted)))
        chosen.append(min(max(nearest, chosen[-1] + 1), len(way) - (count - k)))
    return [float(time) for time in run.times[chosen]]


def _way(before: Frame, after: Frame) -> float:
    """How far the particles move that are in both frames; where openings have exchanged all, by their velocity. [m]"""
    _, old, new = np.intersect1d(before.id, after.id, assume_unique=True, return_indices=True)
    ways = after.position[new] - before.position[old]
    if len(ways) == 0 and "velocity" in after.columns:
        ways = (after.time - before.time) * after.velocity
    return float(np.sqrt(np.mean(ways**2))) if len(ways) else 0.0
