"""history.csv for the page: which columns share a plot, and their numbers. Nothing is drawn here."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from reporting.packing import pack_table
from reporting.runs import Run

AXES = "xyz"
MOST_ROWS = 50_000  # of a history in the page: 8 bytes for each of its about 15 columns, 6 MB before deflate


@dataclass(frozen=True)
class Plot:
    """Columns of history.csv that share a unit."""

    title: str
    columns: dict[str, str]  # column: its name in the legend
    unit: str = ""
    logarithmic: bool = False

    def as_json(self) -> dict[str, Any]:
        return {"title": self.title, "columns": self.columns, "unit": self.unit, "logarithmic": self.logarithmic}


def plots(runs: list[Run]) -> list[Plot]:
    """What is worth a plot: nothing that is empty, or always zero, in all runs. Several runs: a column per plot."""
    per_metre = all(run.dimension == 2 for run in runs)
    shown = [_with_units(_with_columns(plot, runs), runs) for plot in _known_plots(per_metre) + _further_plots(runs)]
    shown = [plot for plot in shown if plot.columns]
    return shown if len(runs) == 1 else [single for plot in shown for single in _one_by_one(plot)]


def _known_plots(per_metre: bool) -> list[Plot]:
    """Columns of every run; in 2-D, quantities per metre of depth."""
    energy, momentum, angular = ("J/m", "N s/m", "J s/m") if per_metre else ("J", "N s", "J s")
    turning = {"angular_momentum": ""} | {f"angular_momentum_{axis}": axis for axis in AXES}
    return [
        Plot("energy", {f"{kind}_energy": kind for kind in ("kinetic", "potential", "total")}, energy),
        Plot("momentum", {f"momentum_{axis}": axis for axis in AXES}, momentum),
        Plot("angular momentum", turning, angular),
        Plot("largest speed", {"max_speed": ""}, "m/s"),
        Plot("overlap / volume", {"overlap": ""}, "1"),
        Plot("error of the velocity", {"error_velocity": ""}, "", True),
        Plot("error of the pressure", {"error_pressure": ""}, "", True),
        Plot("largest divergence", {"max_divergence": ""}, "1/s"),
        Plot("iterations", {"iterations": ""}),
        Plot("residual, relative", {"residual": ""}, "1", True),
        Plot("active nodes", {"active_nodes": ""}),
        Plot("time step", {"dt": ""}, "s"),
    ]


def _further_plots(runs: list[Run]) -> list[Plot]:
    """Probes and what other systems have added."""
    known = {column for plot in _known_plots(True) for column in plot.columns} | {"step", "time"}
    further = dict.fromkeys(column for run in runs for column in run.history if column not in known)
    return [Plot(column.replace("_", " "), {column: ""}, _unit(column)) for column in further]


def _unit(column: str) -> str:
    """Of a probe's column: NAME_pressure, NAME_velocity_x."""
    return "Pa" if column.endswith("_pressure") else "m/s" if column[:-1].endswith("_velocity_") else ""


def _with_units(plot: Plot, runs: list[Run]) -> Plot:
    """With the unit that the runs themselves give the columns, if it is one and the same."""
    units = {run.units[column] for run in runs for column in plot.columns if column in run.units}
    unit = units.pop() if len(units) == 1 else plot.unit
    return Plot(plot.title, plot.columns, unit if unit != "1" or plot.unit else "", plot.logarithmic)


def _with_columns(plot: Plot, runs: list[Run]) -> Plot:
    columns = {column: name for column, name in plot.columns.items()
               if any(_says_something(run.series(column), column) for run in runs)}
    if "potential_energy" not in columns:
        columns.pop("total_energy", None)  # is the kinetic one
    return Plot(plot.title, columns, plot.unit, plot.logarithmic)


def _says_something(values: np.ndarray | None, column: str) -> bool:
    if values is None or not np.any(np.nan_to_num(values)) or np.isfinite(values).sum() < 2:
        return False
    return column != "dt" or np.ptp(values[1:-1]) > 1e-9 * values.max() if len(values) > 3 else True


def _one_by_one(plot: Plot) -> list[Plot]:
    many = len(plot.columns) > 1
    return [Plot(f"{name} {plot.title}" if many else plot.title, {column: ""}, plot.unit, plot.logarithmic)
            for column, name in plot.columns.items()]


def packed_history(run: Run, shown: list[Plot], add: Any) -> dict[str, Any] | None:
    """The columns of these plots. `add(text)` keeps packed numbers and gives the key to find them by."""
    names = [name for plot in shown for name in plot.columns if run.series(name) is not None]
    rows = len(run.history.get("time", ()))
    if not names or not rows:
        return None
    every = -(-rows // MOST_ROWS)
    columns = [run.series(name)[::every] for name in ["time"] + names]
    return {"columns": ["time"] + names, "rows": len(columns[0]), "every": every, "key": add(pack_table(columns))}
