"""Which runs and which columns of their histories can be compared."""

from __future__ import annotations

import difflib

import numpy as np

from reporting.runs import NoResults, Run

# What tells of the grid and the solver, not of the flow.
TECHNICAL = {"step", "time", "dt", "max_divergence", "active_nodes", "iterations", "residual", "contact_passes",
             "contact_unsettled", "particles"}


def read_finished(folder: str) -> Run:
    """A run that has come to its end and whose files can be read."""
    run = Run(folder)
    run.require_whole()
    if run.status == "done" and run.summary.get("complete", True):
        return run
    how = "stopped" if run.status == "done" else run.status
    until = f" at {run.summary['time']:.6g} s" if "time" in run.summary else ""
    raise NoResults(f"{run.folder}: {how}{until}; expected: a finished run; `minamo run SCENE --resume` goes on with "
                    "it")


def require_alike(runs: list[Run]) -> None:
    """Runs in 2-D are not compared with runs in 3-D."""
    last = runs[-1]
    for run in runs[:-1]:
        if run.dimension != last.dimension:
            raise NoResults(f"{run.folder} has dimension {run.dimension}, {last.folder} {last.dimension}; "
                            "expected: runs of the same dimension")


def common_end(runs: list[Run]) -> float:
    """All histories begin at 0; the earliest of their ends. [s]"""
    for run in runs:
        if len(run.history.get("time", ())) < 2:
            raise NoResults(f"{run.folder}: no common time, history.csv has no row after the start; "
                            "expected: a run of one step or more")
    return min(float(run.history["time"][-1]) for run in runs)


def chosen_columns(runs: list[Run], wanted: list[str] | None) -> list[str]:
    """Those wanted, which all runs must have; else all that all have and that tell of the flow."""
    common = [name for name in runs[-1].history if all(name in run.history for run in runs)]
    for name in wanted or ():
        for run in runs:
            if name not in run.history:
                near = difflib.get_close_matches(name, common, 1, 0.4)
                raise NoResults(f"{run.folder}: history.csv has no column \"{name}\"; columns of all runs: "
                                f"{', '.join(common)}" + (f"; nearest: {near[0]}" if near else ""))
    found = wanted or [name for name in common if name not in TECHNICAL and _says_something(runs, name)]
    if not found:
        raise NoResults(f"{runs[-1].folder}: no common column of the histories but {', '.join(common)}; "
                        "expected: runs that measure the same")
    return found


def _says_something(runs: list[Run], name: str) -> bool:
    """Not a constant, like the place of a body at rest. Errors against an exact solution are empty after a time; they
    count where they are not."""
    numbers = [run.history[name][np.isfinite(run.history[name])] for run in runs]
    return all(len(each) > 1 for each in numbers) and np.ptp(np.concatenate(numbers)) > 0
