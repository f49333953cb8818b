"""The folder of a run as arrays."""

from __future__ import annotations

import json
import os
from functools import cached_property
from pathlib import Path

import numpy as np

from .errors import InputError


def _missing(path: Path, expected: str):
    text = f"{path}: no such file\n  expected  {expected}"
    return InputError(text, [(str(path), "", "no such file", expected, "", "", text)])


class Run:
    """What `minamo run` has left in a folder. Files are read when they are asked for, so that a run that goes on can be
    looked at.

        r = minamo.Run("out/short")
        print(len(r.history["time"]), r.particles(0)["position"].shape)   # -> 21 (1800, 2)

    :param folder: that of the run
    :raises InputError: if there is no run in it, or, later, not the file that is asked for
    """

    def __init__(self, folder: str | os.PathLike[str]):
        self.folder = Path(folder)
        if not (self.folder / "scene.json").is_file():
            raise _missing(self.folder / "scene.json", "the folder of a run")

    @cached_property
    def scene(self) -> dict:
        """The scene as run, with all defaults."""
        return json.loads((self.folder / "scene.json").read_text())

    @property
    def summary(self) -> dict:
        """What summary.json says: status, times, conservation, errors, time per system; scenes/README.md has its keys.

        :raises FileNotFoundError: before the run has ended
        """
        return json.loads((self.folder / "summary.json").read_text())

    @property
    def history(self) -> dict[str, np.ndarray]:
        """history.csv, `{column: (rows,)}`, in the units of :attr:`units`; NaN for an empty cell."""
        with open(self.folder / "history.csv") as file:
            names = file.readline().rstrip("\n").split(",")
            rows = [line.rstrip("\n").split(",") for line in file]
        table = np.array([[float(cell) if cell else np.nan for cell in row] for row in rows]).reshape(-1, len(names))
        return dict(zip(names, table.T.copy()))

    @property
    def units(self) -> dict[str, str]:
        """The units of the columns of the history, "1" without one; in 2-D those per metre of depth."""
        path = self.folder / "history.units.json"
        return json.loads(path.read_text()) if path.is_file() else {}

    def _fields(self):
        import h5py

        path = self.folder / "fields.h5"
        if not path.is_file():
            raise _missing(path, "the fields of a run")
        try:
            return h5py.File(path, "r")
        except OSError as error:  # HDF5 does not say which file
            raise OSError(f"{path}: cannot be read: {error}") from error

    @property
    def times(self) -> np.ndarray:
        """The time of every frame, `(frames,)`. [s]"""
        with self._fields() as file:
            frames = file.get("particles", {})
            return np.array([frames[str(k)].attrs["time"] for k in range(len(frames))])

    def __len__(self) -> int:
        """How many frames there are."""
        with self._fields() as file:
            return len(file.get("particles", {}))

    def particles(self, k: int = -1) -> dict[str, np.ndarray]:
        """Frame `k`, counted from the end where it is negative, as fields.h5 has it: `position` `(particles, d)` [m],
        `velocity` `(particles, 3)` [m/s], its third component zero in 2-D, `pressure` `(particles,)` [Pa], `id`, and
        what the scheme carries, in single precision unless the scene says otherwise; what `/output/fields` leaves out is
        not there. Particles change places from frame to frame; `id` tells who is who.

        :raises IndexError: if there is no such frame
        """
        return self._frame("particles", k)

    def bodies(self, k: int = -1) -> dict[str, dict[str, np.ndarray]]:
        """Of frame `k` by the body's name: its outline and what it feels, as fields.h5 has them; empty without
        bodies.

        :raises IndexError: if there is no such frame
        """
        return self._frame("bodies", k)

    def _frame(self, of: str, k: int):
        with self._fields() as file:
            count = len(file.get("particles", {}))
            if not -count <= k < count:
                raise IndexError(f"frame {k} of {count}")
            group = file.get(f"{of}/{k % count}")
            return {} if group is None else _arrays(group)

    def __repr__(self) -> str:
        return f"minamo.Run({str(self.folder)!r})"


def _arrays(group) -> dict:
    return {name: item[()] if hasattr(item, "shape") else _arrays(item) for name, item in group.items()}


def results(folder: str | os.PathLike[str]) -> Run:
    """The results in a folder; the same as :class:`Run`."""
    return Run(folder)
