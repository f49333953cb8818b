"""Systems, columns and parts that are written in python."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Union

from . import _minamo
from .errors import InputError


def _refuse(where: str, what: str, expected: str, got: str) -> None:
    text = f"{where}: {what}\n  expected  {expected}\n  got       {got}"
    raise InputError(text, [(where, "", what, expected, got, "", text)])


class Column(_minamo.DescribedColumn):
    """A column of one's own, which exists in every simulation that has a system with it.

        age = minamo.column("particle.age", unit="s")
        dye = minamo.column("particle.dye", "vector", start=1)

    :param name: `table.quantity`, like `"particle.temperature"`
    :param shape: of a value: `"scalar"`, `"vector"` or `"matrix"`
    :param unit: SI; `"1"` is dimensionless
    :param lifetime: `"state"`: carried along, from step to step and wherever its row goes; `"scratch"`: written anew in
        every step before it is read
    :param symbol: as in equations
    :param start: the value of all rows at the start
    :raises InputError: for a wrong name, shape or lifetime
    """

    def __init__(self, name: str, shape: str = "scalar", *, unit: str = "1", symbol: str = "",
                 lifetime: str = "state", start: float = 0.0):
        if name.count(".") != 1 or name.startswith(".") or name.endswith("."):
            _refuse("column", "wrong name", "table.quantity, like \"particle.temperature\"", repr(name))
        if shape not in ("scalar", "vector", "matrix"):
            _refuse(f'column "{name}"', "unknown shape", '"scalar", "vector" or "matrix"', repr(shape))
        if lifetime not in ("state", "scratch"):
            _refuse(f'column "{name}"', "unknown lifetime", '"state" or "scratch"', repr(lifetime))
        super().__init__(name, shape, unit, symbol, lifetime == "state", float(start))
        self.name = name

    def __repr__(self) -> str:
        return f"minamo.Column({self.name!r})"


#: The same, in the voice of :func:`system` and :func:`part`.
column = Column

#: A component of the program by its name, or a column of one's own.
Component = Union[str, Column]


@dataclass(frozen=True)
class System:
    """A function with its place in the step and what it declares; made by :func:`system`."""

    function: Callable[..., Any]  #: what is called
    name: str  #: in messages and profiles
    slot: str  #: where it stands
    reads: tuple[Component, ...] = ()  #: read-only arrays
    writes: tuple[Component, ...] = ()  #: arrays to fill
    updates: tuple[Component, ...] = ()  #: arrays to change
    standing: bool = True  #: whether it runs in the standing step, too

    def __call__(self, *arguments):
        """The function itself, for tests of it."""
        return self.function(*arguments)


def _require_arguments(system: System) -> None:
    """One parameter per component."""
    declared = len(system.reads) + len(system.writes) + len(system.updates)
    try:
        inspect.signature(system.function).bind(*range(declared))
    except TypeError:
        _refuse(f'system "{system.name}"', "does not take what it declares",
                f"{declared} parameters: what it reads, writes and updates, in this order",
                str(inspect.signature(system.function)))


def system(*, slot: str, reads: Iterable[Component] = (), writes: Iterable[Component] = (),
           updates: Iterable[Component] = (), name: str | None = None,
           standing: bool = True) -> Callable[[Callable[..., Any]], System]:
    """Makes a function a system. It is called once in every step, with an array per component: first what it reads,
    which is read-only, then what it writes, then what it updates.

        @minamo.system(slot="g2p", reads=["particle.position"], updates=["particle.velocity"])
        def damp(x, v):
            v[x[:, 0] > 0.5] *= 0.99

    :param slot: it stands at the end of this slot; `minamo.list("systems")` tells what others do, the README their order
    :param reads: what it looks at
    :param writes: what it gives every row a new value; the old ones are not there any more
    :param updates: what it looks at and changes
    :param name: by default that of the function
    :param standing: whether it also runs in the standing step, which gives the first pressure

    Next to columns there are `clock`, which is read and has `time`, `step`, `end_of_step` [s] and `index`, and
    `measure.columns`, which is updated: `columns["name"] = value` in slot `measure` is a column of the history.

    The arrays are those of the simulation, for this call only: who keeps one gets an error. Systems in python run one at
    a time. What the function raises comes out of :meth:`Simulation.step`, with the step taken back; `StepRejected` makes
    it be tried again at half its length.

    :raises InputError: if the function does not take what it declares; unknown names and slots are found by
        :class:`Simulation`
    """

    def make(function: Callable[..., Any]) -> System:
        made = System(function, name or function.__name__, slot, tuple(reads), tuple(writes), tuple(updates), standing)
        _require_arguments(made)
        return made

    for key, names in {"reads": reads, "writes": writes, "updates": updates}.items():
        if isinstance(names, (str, Column)):
            _refuse("system", f"{key} is one name", "a list of names", repr(names))
    return make


@dataclass(frozen=True)
class Number:
    """An option of a part: a number in the scene.

        rate = minamo.Number("1/s", "share of the heat lost", default=0.1, at_least=0)
    """

    unit: str = "1"  #: SI; `"1"` is dimensionless
    doc: str = ""  #: one line
    default: float | None = None  #: `None`: the key is required
    at_least: float | None = None  #: least that is allowed
    at_most: float | None = None  #: most that is allowed


@dataclass(frozen=True)
class Part:
    """A key of scenes and the systems that it brings; made by :func:`part`."""

    systems: Callable[..., Iterable[System]]  #: what makes them
    name: str  #: the key
    doc: str  #: one line
    options: dict[str, Number]  #: its numbers by name


def part(name: str, doc: str = "", **options: Number) -> Callable[[Callable[..., Iterable[System]]], Part]:
    """Makes a function a part: scenes may have the key `name`, an object with these numbers. For a scene that has it the
    function is called with them and returns the systems.

        temperature = minamo.column("particle.temperature", unit="K", start=300)

        @minamo.part("cooling", "heat lost to the walls", rate=minamo.Number("1/s", "share lost", at_least=0))
        def cooling(rate):
            @minamo.system(slot="g2p", reads=["clock"], updates=[temperature])
            def cool(clock, T):
                T *= 1 - rate * clock.step
            return [cool]

        scene = sim.scene | {"cooling": {"rate": 0.1}}
        minamo.Simulation(scene, parts=[cooling])

    :param name: the key; that of no other part
    :param doc: one line; by default the docstring of the function
    :param options: its numbers, each a :class:`Number`
    """

    def make(function: Callable[..., Iterable[System]]) -> Part:
        return Part(function, name, doc or (function.__doc__ or "").strip(), options)

    return make
