"""Parts that the scenes of the cases are built of. All lengths are sums of powers of two, as far as a case allows it."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np

Scene = dict[str, Any]
FRAMES = 20  # of a run


def scene(cells: list[int], spacing: float, particles: list[Scene], end: float, step: float, **more: Any) -> Scene:
    """A box from the origin. Lengths in m, times in s; water that does not fall, unless said."""
    dimension = len(cells)
    return {"dimension": dimension,
            "grid": {"low": [0.0] * dimension, "high": [n * spacing for n in cells], "cells": cells},
            "walls": "slip",
            "fluid": {"density": 1000.0, "viscosity": 1e-3},
            "body_force": [0.0] * dimension,
            "particles": particles,
            "time": {"end": end, "step": step},
            "output": {"every": end / FRAMES}} | more


def box(low: list[float], high: list[float], per_cell: int = 2, velocity: list[Any] | None = None,
        **more: Any) -> Scene:
    region = {"shape": {"box": {"low": low, "high": high}}, "per_cell": per_cell} | more
    return region | ({"velocity": velocity} if velocity else {})


def ball(center: list[float], radius: float, per_cell: int = 2, velocity: list[Any] | None = None) -> Scene:
    region = {"shape": {"ball": {"center": center, "radius": radius}}, "per_cell": per_cell}
    return region | ({"velocity": velocity} if velocity else {})


def particle(cell: list[int], spacing: float, per_cell: int = 1, velocity: list[Any] | None = None) -> Scene:
    """The first particle of a cell: its middle with one per cell."""
    middle = [(n + 0.5 / per_cell) * spacing for n in cell]
    part = spacing / per_cell
    return box([x - part / 4 for x in middle], [x + part / 4 for x in middle], per_cell, velocity)


def down(dimension: int, g: float = 9.75) -> list[float]:
    """Gravity against the last axis. [m/s^2]"""
    return [0.0] * (dimension - 1) + [-g]


def dam_break(cells: int = 16, per_cell: int = 2, end: float = 1.0, step: float = 4e-3, **more: Any) -> Scene:
    """A column a quarter as wide and half as high as a tank of 1 m."""
    return scene([cells, cells], 1 / cells, [box([0, 0], [0.25, 0.5], per_cell)], end, step,
                 body_force=down(2)) | more


def dam_break_in_space(cells: int = 12, per_cell: int = 2, end: float = 0.5, step: float = 8e-3, **more: Any) -> Scene:
    """The same in the corner of a tank of 1 m x 1/2 m x 1 m."""
    return scene([cells, cells // 2, cells], 1 / cells, [box([0, 0, 0], [0.25, 0.25, 0.5], per_cell)], end, step,
                 body_force=down(3)) | more


def with_cfl(of: Scene, cfl: float) -> Scene:
    return of | {"time": {"end": of["time"]["end"], "cfl": cfl}}


def in_other_units(of: Scene, length: float, time: float, density: float = 1.0) -> Scene:
    """The same flow, every number multiplied by the units given: a meter is `length` of the new ones, and so on."""
    new = copy.deepcopy(of)
    speed = length / time
    for key in ("low", "high"):
        new["grid"][key] = [x * length for x in of["grid"][key]]
    for region in new["particles"]:
        shape = next(iter(region["shape"].values()))
        for key, value in shape.items():
            shape[key] = value * length if key == "radius" else [x * length for x in value]
        if "velocity" in region:
            region["velocity"] = [v * speed for v in region["velocity"]]
    new["fluid"] = {"density": of["fluid"]["density"] * density,
                    "viscosity": of["fluid"]["viscosity"] * density * length * speed}
    new["body_force"] = [b * speed / time for b in of["body_force"]]
    new["time"] = {key: value * (1 if key == "cfl" else time) for key, value in of["time"].items()}
    new["output"] = {"every": of["output"]["every"] * time}
    return new


def turned(of: Scene, axes: list[int], mirrored: list[bool]) -> Scene:
    """The scene with new axis d the old axis axes[d], the other way round where mirrored. Its box starts at the origin
    and its regions are boxes or balls."""
    new = copy.deepcopy(of)
    old_high = of["grid"]["high"]
    length = [old_high[a] for a in axes]
    new["grid"]["high"] = length
    new["grid"]["cells"] = [of["grid"]["cells"][a] for a in axes]
    sign = [-1 if m else 1 for m in mirrored]
    new["body_force"] = [s * of["body_force"][a] for s, a in zip(sign, axes)]
    for region in new["particles"]:
        kind, shape = next(iter(region["shape"].items()))
        place = {key: [length[d] - value[a] if mirrored[d] else value[a] for d, a in enumerate(axes)]
                 for key, value in shape.items() if key != "radius"}
        if kind == "box":
            corners = np.array([place["low"], place["high"]])
            place = {"low": corners.min(axis=0).tolist(), "high": corners.max(axis=0).tolist()}
        shape.update(place)
        if "velocity" in region:
            region["velocity"] = [s * region["velocity"][a] for s, a in zip(sign, axes)]
    return new
