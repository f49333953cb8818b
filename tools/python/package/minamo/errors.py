"""What can go wrong, in the words of the program."""

from __future__ import annotations

from typing import NamedTuple


class Problem(NamedTuple):
    """One thing wrong with an input; `str()` of it is what the program prints."""

    file: str  #: the scene file, `scene` for a dict, or the system in question
    pointer: str  #: JSON pointer of the place; empty where the whole is meant
    what: str
    expected: str
    got: str
    closest: str  #: the nearest known name
    text: str

    def __str__(self) -> str:
        return self.text


class Error(Exception):
    """Base of all exceptions of minamo."""


class InputError(Error, ValueError):
    """A scene or an argument is wrong; nothing was run. `problems` has every problem of it."""

    def __init__(self, text: str, problems=()):
        super().__init__(text)
        self.problems = [Problem(*problem) for problem in problems]


class UnknownName(InputError, KeyError):
    """There is no such component; a `KeyError`, too."""

    __str__ = Exception.__str__


class ScheduleError(Error, ValueError):
    """The systems do not fit together: one reads what none writes. A line per problem."""


class RunError(Error, RuntimeError):
    """A step has failed. The simulation stands where the last accepted step has left it."""


class StepRejected(Exception):
    """For systems written in python: raise it, and the step is taken back and tried again at half its length."""
