"""Runs a case at a resolution and measures its curves."""

from __future__ import annotations

import csv
import json
import time
from pathlib import Path
from typing import Any

import numpy as np

from case import Case, Curve, Points, Result

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "scenes/validation"


def scene_file(case: Case) -> str:
    """Relative to the page."""
    name = case.scene or case.name
    return f"{name}.json" if (SCENES / f"{name}.json").exists() else f"../{name}.json"


def scene_of(case: Case, changes: dict[str, Any]) -> dict[str, Any]:
    """The scene with what a resolution sets; files that it names are looked for next to it."""
    path = SCENES / scene_file(case)
    scene = json.loads(path.read_text())
    for pointer, value in changes.items():
        *way, last = pointer.strip("/").split("/")
        inner: Any = scene
        for key in way:
            inner = inner[int(key)] if isinstance(inner, list) else inner[key]
        inner[last] = value
    for body in scene.get("bodies", []):
        if "table" in body.get("motion", {}):
            body["motion"]["table"]["file"] = str(path.parent / body["motion"]["table"]["file"])
    return scene


def measured(curve: Curve, folder: Path) -> Points:
    """The curve of the experiment, in the order of x."""
    with open(folder / curve.file, newline="") as file:
        rows = [(float(row[curve.time_column]), float(row[curve.column])) for row in csv.DictReader(file)]
    rows.sort()
    return Points(*np.array(rows).T)


def computed(case: Case, file: str) -> dict[str, Points]:
    """The curves that another program computed; x is the first column."""
    with open(SCENES / file, newline="") as table:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(table)]
    x = np.array([row[case.x_label] for row in rows])
    return {curve.name: Points(x, np.array([row[curve.name] for row in rows])) for curve in case.curves}


def smoothed(points: Points) -> Points:
    """Mean over 1/200 of the time shown, around every step."""
    half = (points.x[-1] - points.x[0]) / 400
    first = np.searchsorted(points.x, points.x - half)
    last = np.searchsorted(points.x, points.x + half, side="right")
    total = np.concatenate([[0], np.cumsum(points.y)])
    return Points(points.x, (total[last] - total[first]) / (last - first))


def run(case: Case, resolution: str, changes: dict[str, Any], threads: int) -> Result:
    import minamo

    before = time.process_time()
    sim = minamo.Simulation(scene_of(case, changes), threads=threads)
    gauges = [curve for curve in case.curves if callable(curve.ours)]
    times: list[float] = []
    values: dict[str, list[float]] = {curve.name: [] for curve in gauges}
    particles = len(sim["particle.position"])
    while True:
        times.append(sim.time)
        for curve in gauges:
            values[curve.name].append(curve.ours(sim))
        if not sim.step():
            break
    cpu_s = time.process_time() - before
    curves = {}
    for curve in case.curves:
        t = np.asarray(times if callable(curve.ours) else sim.history["time"]) - curve.begin
        value = np.asarray(values[curve.name] if callable(curve.ours) else sim.history[curve.ours])
        known = np.isfinite(value) & (t >= 0)  # at the start a body has no force
        curves[curve.name] = smoothed(Points(curve.time_scale * t[known], curve.scale * (value[known] + curve.offset)))
    return Result(resolution, curves, particles, sim.steps, cpu_s)
