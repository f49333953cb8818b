"""minamo from python: simulations in memory, systems written in python, results as arrays.

    import minamo
    sim = minamo.Simulation("scenes/dam_break.json")
    sim.run(until=0.2)
    print(sim["particle.velocity"].shape)   # -> (1800, 2)

All quantities are in SI units, in 2-D per metre of depth. In shapes, `d` is the dimension: 2 or 3.
"""

from ._minamo import __version__
from .errors import Error, InputError, Problem, RunError, ScheduleError, StepRejected, UnknownName
from .results import Run, results
from .simulation import Simulation, check, list, run, schema
from .systems import Column, Number, Part, System, column, part, system

__all__ = [
    "Column", "Error", "InputError", "Number", "Part", "Problem", "Run", "RunError", "ScheduleError", "Simulation",
    "StepRejected", "System", "UnknownName", "check", "column", "list", "part", "results", "run", "schema", "system",
]
