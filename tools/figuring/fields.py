"""What particles are coloured by: what fields.h5 has of them, and what follows from that."""

from __future__ import annotations

import difflib
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import Colormap, ListedColormap

from figuring.plots import COLOURS
from reporting.runs import NoResults, Run

AXES = "xyz"
SEQUENTIAL, SIGNED = "viridis", "coolwarm"  # perceptually uniform; told apart by all eyes
UNITS = {"mass": ("kg/m", "kg"), "volume": ("m²", "m³")}  # in 2-D, in 3-D
NOT_FINITE = "#ff00ff"  # in none of the maps


@dataclass(frozen=True)
class Field:
    """A number per particle."""

    name: str
    unit: str
    values: Callable[[dict[str, np.ndarray]], np.ndarray]  # from the columns of a frame
    colours: str = SEQUENTIAL
    classes: tuple[str, ...] = ()  # what 0, 1, ... stand for, where a number is no size

    @property
    def colour_map(self) -> Colormap:
        if self.classes:
            return ListedColormap(COLOURS[:len(self.classes)])
        return colormaps[self.colours].with_extremes(bad=NOT_FINITE)

    @property
    def label(self) -> str:
        return self.name.replace("_", " ") + (f" [{self.unit}]" if self.unit else "")


def fields_of(run: Run) -> dict[str, Field]:
    """All that the particles of a run can be coloured by."""
    columns, dimension = run.columns(0), run.dimension
    found = []
    if "velocity" in columns:
        found.append(Field("speed", "m/s", lambda columns: np.linalg.norm(columns["velocity"], axis=1)))
        found += [_part("velocity", "m/s", k, AXES[k]) for k in range(dimension)]
    if "pressure" in columns:
        found.insert(1 if found else 0, Field("pressure", "Pa", lambda columns: columns["pressure"], "cividis"))
    if "velocity_gradient" in columns:
        found.append(Field("vorticity", "1/s", _vorticity, SIGNED if dimension == 2 else SEQUENTIAL))
        pairs = [(i, j) for i in range(dimension) for j in range(dimension)]
        found += [_part("velocity_gradient", "1/s", k, AXES[i] + AXES[j]) for k, (i, j) in enumerate(pairs)]
    if "fluid" in columns:
        found.append(Field("fluid", "", lambda columns: columns["fluid"].astype(float), classes=run.fluids))
    for name, values in columns.items():
        if name not in ("fluid", "position", "velocity", "pressure", "velocity_gradient"):
            parts = range(values.shape[1]) if values.ndim > 1 else ()
            unit = UNITS.get(name, ("", ""))[dimension - 2]
            found += [_part(name, unit, k, str(k)) for k in parts] or [_whole(name, unit)]
    return {field.name: field for field in found}


def _whole(column: str, unit: str) -> Field:
    return Field(column, unit, lambda columns: columns[column].astype(float))


def _part(column: str, unit: str, k: int, name: str) -> Field:
    return Field(f"{column}_{name}", unit, lambda columns: columns[column][:, k], SIGNED)


def _vorticity(columns: dict[str, np.ndarray]) -> np.ndarray:
    """dv/dx - du/dy; in 3-D the magnitude of the curl. The gradient has dv_i/dx_j in row i, column j. [1/s]"""
    dimension = columns["position"].shape[1]
    gradient = columns["velocity_gradient"].reshape(-1, dimension, dimension)
    turning = gradient - gradient.transpose(0, 2, 1)
    return turning[:, 1, 0] if dimension == 2 else np.sqrt(0.5) * np.linalg.norm(turning, axis=(1, 2))


def _source(name: str) -> str:
    """The column of fields.h5 that a field is made of, which a run may have left out; empty for others."""
    sources = {"speed": "velocity", "vorticity": "velocity_gradient", "velocity_gradient": "velocity_gradient",
               "velocity": "velocity"}
    whole = name if name in sources else name.rpartition("_")[0]
    return sources.get(whole, name if name in ("pressure", "mass", "volume") else "")


def usual_fields(runs: list[Run]) -> list[str]:
    """What is drawn if nothing is asked for: which liquid, where there are several, and what the flow is."""
    known = [fields_of(run) for run in runs]
    wanted = (["fluid"] if all(run.fluids for run in runs) else []) + ["speed", "pressure"]
    return [name for name in wanted if all(name in fields for fields in known)] or list(known[0])[:1]


def find_field(runs: list[Run], name: str) -> Field:
    """The field of that name, which all runs must have."""
    for run in runs:
        known = fields_of(run)
        if name not in known:
            source = _source(name)
            if source and source not in run.field_names:
                raise NoResults(f"{run.folder}: fields.h5 has no {source}, which \"{name}\" is made of; expected: a run "
                                f"with \"{source}\" in /output/fields")
            near = difflib.get_close_matches(name, known, 1, 0.4)
            raise NoResults(f"{run.folder}: unknown field \"{name}\"; expected one of: {', '.join(known)}"
                            + (f"; nearest: {near[0]}" if near else ""))
    return known[name]
