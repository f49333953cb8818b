"""The extension below the package minamo, whose functions and classes are what to use."""

from typing import Any, Iterable

import numpy as np

__version__: str

class DescribedColumn:
    def __init__(self, name: str, shape: str, unit: str, symbol: str, is_state: bool, start: float) -> None: ...

class HistoryColumns:
    """`measure.columns` in the arguments of a system that updates them, in slot `measure`.

        @minamo.system(slot="measure", reads=["particle.mass"], updates=["measure.columns"])
        def total_mass(m, columns):
            columns["total_mass"] = m.sum()
    """

    def __setitem__(self, name: str, value: float) -> None:
        """Sets a column of the history for this row; NaN is an empty cell."""

class Clock:
    """`clock` in the arguments of a system that reads it: where the step stands in time.

        @minamo.system(slot="g2p", reads=["clock"], updates=["particle.velocity"])
        def brake(clock, v):
            v *= 1 - 0.1 * clock.step
    """

    @property
    def time(self) -> float:
        """At the start of the step. [s]"""
    @property
    def step(self) -> float:
        """Length of the step. [s]"""
    @property
    def end_of_step(self) -> float:
        """At the end of the step. [s]"""
    @property
    def index(self) -> int:
        """Steps that are done; 0 in the first one."""

class Simulation:
    def __init__(self, text: str | None, name: str, systems: Iterable[Any], parts: Iterable[Any],
                 threads: int) -> None: ...
    def advance(self, steps: int | None, until: float | None) -> int: ...
    def column(self, name: str) -> np.ndarray: ...
    def columns(self) -> list[tuple[str, str, str, str, str, bool]]: ...
    def scene(self) -> str: ...
    def history(self, rows: int) -> np.ndarray: ...
    def history_rows(self) -> int: ...
    def history_columns(self) -> list[str]: ...
    @property
    def time(self) -> float: ...
    @property
    def last_step(self) -> float: ...
    @property
    def steps(self) -> int: ...
    @property
    def rejected(self) -> int: ...
    @property
    def is_over(self) -> bool: ...
    @property
    def dimension(self) -> int: ...
    @property
    def threads(self) -> int: ...
    @property
    def grid(self) -> dict[str, Any]: ...

def run(text: str | None, name: str, systems: Iterable[Any], parts: Iterable[Any], folder: str, threads: int,
        steps: int | None, resume: bool, overwrite: bool, quiet: bool) -> None: ...
def list(what: str) -> list[dict[str, Any]]: ...
def check(text: str | None, name: str, systems: Iterable[Any], parts: Iterable[Any]) -> list[tuple[str, ...]]: ...
def schema() -> str: ...
