"""What can go wrong, in the words of the program."""

from __future__ import annotations

from typing import NamedTuple


class Problem(NamedTuple):
    """One thing wrong with an input; `str()` of it is what the program prints. All fields are texts; some may be empty.

        problem = minamo.check({"dimension": 4})[0]
        print(problem.pointer, problem.expected)   # -> /dimension a whole number in [2, 3]
    """

    file: str  #: the scene file, `scene` for a dict, or the system in question
    pointer: str  #: JSON pointer of the place; empty where the whole is meant
    what: str  #: what is wrong
    expected: str  #: what should stand there
    got: str  #: what stands there
    closest: str  #: the nearest known name
    text: str  #: the whole message

    def __str__(self) -> str:
        return self.text


class Error(Exception):
    """Base of all exceptions of minamo."""


class InputError(Error, ValueError):
    """A scene or an argument is wrong; nothing was run. `problems` is a list with every :class:`Problem` of it.

        try:
            minamo.Simulation({"dimension": 4})
        except minamo.InputError as error:
            print(len(error.problems) > 1)   # -> True
    """

    def __init__(self, text: str, problems=()):
        super().__init__(text)
        self.problems = [Problem(*problem) for problem in problems]


class UnknownName(InputError, KeyError):
    """There is no column of this name in the simulation; a `KeyError`, too."""

    __str__ = Exception.__str__


class ScheduleError(Error, ValueError):
    """The systems do not fit together: one reads what none writes. A line per problem."""


class RunError(Error, RuntimeError):
    """A step has failed. The simulation stands where the last accepted step has left it."""


class StepRejected(Exception):
    """For systems written in python: raise it, and the step is taken back and tried again at half its length.

        @minamo.system(slot="measure", reads=["clock"])
        def short_steps(clock):
            if clock.step > 1e-3:
                raise minamo.StepRejected("longer than 1 ms")
    """
