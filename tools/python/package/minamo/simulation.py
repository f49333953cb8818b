"""Simulations in memory, and runs into a folder."""

from __future__ import annotations

import builtins
import json
import numbers
import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, Union

import numpy as np

from . import _minamo
from .errors import InputError, UnknownName
from .systems import Part, System

#: A scene file, or what is in one.
Scene = Union[str, "os.PathLike[str]", dict]


def _plain(value: Any):
    """NumPy's numbers and arrays as JSON has them."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    raise TypeError(f"a scene has numbers, texts, lists and dicts; got {value!r}")


def _text(scene: Scene) -> tuple[str | None, str]:
    """The scene as JSON, none for a file, and what messages call it."""
    if isinstance(scene, dict):
        return json.dumps(scene, default=_plain), "scene"
    return None, os.fspath(scene)


class Simulation:
    """A scene that runs in memory, a step at a time. It computes what `minamo run` computes, bit for bit, and writes
    nothing.

        sim = minamo.Simulation("scenes/dam_break.json", threads=1)
        print(sim.run(until=0.1) == sim.steps, sim.time)   # -> True 0.1

    :param scene: the path of a scene file, or a dict with the same keys
    :param threads: 1 to the number of processors; `None`: all of them. The results do not depend on it.
    :param systems: further systems, see :func:`minamo.system`
    :param parts: further keys of scenes, see :func:`minamo.part`
    :raises InputError: with every problem of the scene
    :raises ScheduleError: if a system reads what none writes

    The start, before the first step, is row 0 of the history, and is computed here.
    """

    def __init__(self, scene: Scene, *, threads: int | None = None, systems: Iterable[System] = (),
                 parts: Iterable[Part] = ()):
        text, name = _text(scene)
        self._core = _minamo.Simulation(text, name, _all(systems, System), _all(parts, Part), _threads(threads))

    # --- time ---

    def step(self, n: int = 1) -> int:
        """Takes `n` steps, or as many as are left until the scene ends. Returns how many.

        :raises InputError: if `n` is no whole number, or negative
        :raises RunError: if a step fails; the simulation stands at the last accepted step and can go on
        :raises KeyboardInterrupt: on Ctrl-C, after the step; the simulation can go on
        """
        return self._core.advance(_whole("n", n, 0), None)

    def run(self, until: float | None = None) -> int:
        """Takes steps until one reaches the time `until` [s], by default to the end of the scene. Returns how many;
        raises as :meth:`step` does."""
        return self._core.advance(None, _time("until", until))

    def watch(self, until: float | None = None, every: int = 10, color: str = "speed") -> int:
        """Takes the steps of :meth:`run` and draws the picture of :meth:`show` in a notebook, anew after every `every`
        steps, in the place of the one before. Returns how many steps it took; raises as :meth:`step` does.

        :param until: time to reach [s]; by default the end of the scene
        :param every: steps between pictures
        :param color: `"speed"`, or a column with a number per particle
        """
        from .picture import live

        until, every = _time("until", until), _whole("every", every, 1)
        redraw = live(self, color)
        steps = 0
        while taken := self._core.advance(every, until):
            steps += taken
            redraw()
        return steps

    @property
    def time(self) -> float:
        """Time that is reached. [s]"""
        return self._core.time

    @property
    def last_step(self) -> float:
        """Length of the last step. [s]"""
        return self._core.last_step

    @property
    def steps(self) -> int:
        """Accepted steps."""
        return self._core.steps

    @property
    def rejected(self) -> int:
        """Attempts at steps that were taken back and made again at half the length."""
        return self._core.rejected

    @property
    def is_over(self) -> bool:
        """Whether the scene has come to its end."""
        return self._core.is_over

    # --- data ---

    def __getitem__(self, name: str) -> np.ndarray:
        """A column, like `sim["particle.velocity"]`: the simulation's own memory, not a copy.

            sim["particle.velocity"][:, 0] = 0             # the next step begins with this
            print(sim["particle.velocity_gradient"].shape)   # -> (1800, 2, 2)

        A number per row has the shape `(rows,)`, a vector `(rows, d)`, a matrix `(rows, d, d)`; :attr:`columns` has the
        units. A column of lifetime `state` can be written; all others, and what is not made of real numbers, are
        read-only. The array shows the column as it is until the next step; from then on it keeps the values that it has
        then, and is read-only. A step copies the columns whose arrays are still held, so let go of large ones that are
        not needed.

        :raises UnknownName: for a name that this simulation has no column of
        """
        try:
            return self._core.column(name)
        except InputError as error:
            raise UnknownName(str(error), error.problems) from None

    def __setitem__(self, name: str, values) -> None:
        """Sets all rows of a column, as `sim[name][:] = values`.

        :raises UnknownName: for a name that this simulation has no column of
        :raises ValueError: if the column is read-only, or `values` has another shape
        """
        self[name][...] = values

    def __contains__(self, name: str) -> bool:
        """Whether there is a column of this name."""
        return name in self.columns

    def __iter__(self) -> Iterator[str]:
        """The names of all columns."""
        return iter(self.columns)

    def keys(self) -> builtins.list[str]:
        """The names of all columns."""
        return builtins.list(self.columns)

    @property
    def columns(self) -> dict[str, dict[str, Any]]:
        """All columns: `{name: {"table", "symbol", "unit", "lifetime", "writable"}}`.

            print(sim.columns["particle.velocity"]["unit"])   # -> m/s
        """
        keys = ("table", "symbol", "unit", "lifetime", "writable")
        return {name: dict(zip(keys, rest)) for name, *rest in self._core.columns()}

    @property
    def row(self) -> dict[str, float]:
        """The last row of the history, `{column: number}`: energies [J], momenta [kg m/s], largest speed [m/s] ... NaN
        for what is not measured. scenes/README.md has all columns with their units."""
        return dict(zip(self._core.history_columns(), self._core.history(1)[0].tolist()))

    @property
    def history(self) -> dict[str, np.ndarray]:
        """All rows so far, `{column: (rows,)}`, the columns of history.csv; row 0 is the start.

            print(len(sim.history["kinetic_energy"]) == sim.steps + 1)   # -> True
        """
        return dict(zip(self._core.history_columns(), self._core.history(self._core.history_rows()).T.copy()))

    # --- scene ---

    @property
    def scene(self) -> dict:
        """The scene with all defaults filled in."""
        return json.loads(self._core.scene())

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self._core.dimension

    @property
    def threads(self) -> int:
        """So many threads take a step."""
        return self._core.threads

    @property
    def grid(self) -> dict[str, Any]:
        """`{"low", "high", "cells", "spacing"}`: corners [m], cells per direction, their width [m]."""
        return self._core.grid

    def show(self, color: str = "speed", ax=None):
        """The particles as a picture of matplotlib; a scene in 3-D is seen along y. Returns the axes.

            ax = sim.show("particle.pressure")   # ax.figure.savefig("pressure.png") keeps it
            print(ax.get_title())                # -> t = 0.1 s

        :param color: `"speed"`, or a column with a number per particle
        :param ax: the axes to draw into; by default those of a new figure
        :raises UnknownName: for a name that this simulation has no column of
        """
        from .picture import show

        return show(self, color, ax)

    def _repr_png_(self) -> bytes:
        from .picture import png

        return png(self)

    def __repr__(self) -> str:
        title = self.scene.get("title") or "untitled"
        return (f"<minamo.Simulation {title!r}: t = {self.time:.6g} s after {self.steps} steps, "
                f"{len(self['particle.mass'])} particles>")


def _out_of_range(name: str, expected: str, got) -> InputError:
    text = f"{name}: out of range\n  expected  {expected}\n  got       {got!r}"
    return InputError(text, [(name, "", "out of range", expected, repr(got), "", text)])


def _whole(name: str, value, least: int) -> int:
    if isinstance(value, bool) or not isinstance(value, numbers.Integral) or value < least:
        raise _out_of_range(name, f"a whole number >= {least}", value)
    return int(value)


def _time(name: str, value: float | None) -> float | None:
    if value is not None and not (isinstance(value, numbers.Real) and value == value):
        raise _out_of_range(name, "a time [s]", value)
    return value


def _threads(threads: int | None) -> int:
    """0 stands for all."""
    return 0 if threads is None else _whole("threads", threads, 1)


def _all(made: Iterable, kind: type) -> builtins.list:
    """What :func:`minamo.system` or :func:`minamo.part` has made, and nothing else."""
    if isinstance(made, kind):
        raise TypeError(f"expected a list, got one {kind.__name__.lower()}")
    made = builtins.list(made)
    for one in made:
        if not isinstance(one, kind):
            raise TypeError(f"expected what minamo.{kind.__name__.lower()} makes, got {one!r}")
    return made


def run(scene: Scene, out: str | os.PathLike[str] | None = None, *, threads: int | None = None,
        steps: int | None = None, resume: bool = False, overwrite: bool = False, quiet: bool = True,
        systems: Iterable[System] = (), parts: Iterable[Part] = ()):
    """Runs a scene into a folder, as `minamo run` does, and returns its :class:`minamo.Run`.

        r = minamo.run("scenes/dam_break.json", "out/short", steps=20, overwrite=True)
        print(r.summary["status"])   # -> done

    :param scene: the path of a scene file, or a dict with the same keys
    :param threads: 1 to the number of processors; `None`: all of them
    :param out: the folder; by default out/NAME, out/scene for a dict
    :param steps: stop after so many steps of the whole run
    :param resume: go on from the checkpoint in the folder
    :param overwrite: replace the results of an unfinished run in the folder
    :param quiet: print nothing; else what the program prints
    :param systems: further systems, see :func:`minamo.system`
    :param parts: further keys of scenes, see :func:`minamo.part`
    :raises InputError: with every problem of the scene, or if an unfinished run is in the folder
    :raises RunError: if a step fails; the last accepted state is in checkpoint.h5
    :raises KeyboardInterrupt: on Ctrl-C, after the step, with a checkpoint
    """
    from .results import Run

    text, name = _text(scene)
    folder = Path("out") / Path(name).stem if out is None else Path(out)
    count = None if steps is None else _whole("steps", steps, 0)
    if resume and overwrite:
        raise ValueError("resume goes on with what overwrite replaces; expected one of them")
    _minamo.run(text, name, _all(systems, System), _all(parts, Part), str(folder), _threads(threads), count, resume,
                overwrite, quiet)
    return Run(folder)


def check(scene: Scene, *, systems: Iterable[System] = (), parts: Iterable[Part] = ()):
    """Every problem of a scene, a list of :class:`Problem`, as `minamo check` reports them; empty if it can be run.

        print(minamo.check("scenes/dam_break.json"))   # -> []
    """
    from .errors import Problem

    text, name = _text(scene)
    return [Problem(*problem) for problem in _minamo.check(text, name, _all(systems, System), _all(parts, Part))]


def list(what: str) -> builtins.list[dict[str, Any]]:  # noqa: A001, named as the program's command
    """What the program has, a dict each.

        schemes = [scheme["name"] for scheme in minamo.list("schemes") if scheme["part"] == "transfer"]
        print(schemes[:3])   # -> ['apic', 'flip', 'fmpm']

    :param what: `"parts"` (`name`, `doc`, `schemes`), `"schemes"` or `"solvers"` (`name`, `doc`, `part`), `"systems"`
        (`name`, `doc`, `reads`, `writes`) or `"components"` (`name`, `table`, `symbol`, `unit`, `lifetime`)
    :raises InputError: for another word
    """
    return _minamo.list(what)


def schema() -> dict:
    """The JSON Schema of scenes, for editors.

        print(minamo.schema()["required"])   # -> ['dimension', 'grid', 'time']
    """
    return json.loads(_minamo.schema())
