"""What the page draws over the particles of its own accord: references that fit a scene, and exact paths of corners.

A reference is a folder of scenes/reference with lines, NAME_tT.csv, and fits.json, the part of a scene that it was made
for. It fits a run if the run's scene.json has all that is in fits.json, numbers within 1e-6 of each other, and no
bodies or openings beside.
"""

from __future__ import annotations

import json
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from reporting.references import read_references
from reporting.runs import Run

REFERENCES = Path(__file__).resolve().parents[2] / "scenes/reference"
AXES = "xyz"


def references(run: Run, folder: Path = REFERENCES) -> list[dict[str, Any]]:
    """Lines of all references that fit, by time: {name, time [s], segments: lists of [x, y] [m]}."""
    found = []
    for condition in sorted(folder.glob("*/fits.json")):
        if fits(json.loads(condition.read_text()), run.scene):
            found += [{"name": curves.name, "time": curves.time,
                       "segments": [np.round(line, 5).tolist() for line in curves.segments]}
                      for curves in read_references(condition.parent)]
    return sorted(found, key=lambda curves: curves["time"])


def fits(wanted: dict[str, Any], scene: dict[str, Any]) -> bool:
    """Whether a scene has all that is wanted of it, and no bodies or openings unless they are wanted."""
    if any(scene.get(key) and key not in wanted for key in ("bodies", "openings")):
        return False
    dimension = int(scene["dimension"])
    given = scene | {"walls": walls(scene.get("walls", "slip"), dimension)}
    if "walls" in wanted:
        wanted = wanted | {"walls": walls(wanted["walls"], dimension)}
    return _has(given, wanted)


def _has(given: Any, wanted: Any) -> bool:
    if isinstance(wanted, dict):
        return isinstance(given, dict) and all(key in given and _has(given[key], wanted[key]) for key in wanted)
    if isinstance(wanted, list):
        return isinstance(given, list) and len(given) == len(wanted) and all(map(_has, given, wanted))
    if _is_number(wanted) and _is_number(given):
        return abs(given - wanted) <= 1e-6 * max(abs(given), abs(wanted))
    return type(given) is type(wanted) and given == wanted


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def walls(given: Any, dimension: int) -> list[list[str]]:
    """The condition at the low and the high side of every axis, however short a scene says it."""
    by_axis = [given.get(axis, "slip") if isinstance(given, dict) else given for axis in AXES[:dimension]]
    return [list(sides) if isinstance(sides, list) else [sides, sides] for sides in by_axis]


def corner_paths(run: Run) -> dict[str, Any] | None:
    """Exact paths x + t v + t^2 b / 2 of the corners of boxes of liquid in 2-D: {start, velocity, acceleration}.

    At a corner two free surfaces meet, the pressure gradient vanishes, and the liquid goes on as in free flight. For a
    square of side L that rotates at the rate w: (L/2) (1 - wt, 1 + wt) and its turned copies. None unless every region
    is a box that no wall and no other region touches, there are no bodies and openings, the body force is constant, and
    the velocity at the start is linear and not everywhere zero.
    """
    boxes = [region["shape"].get("box") for region in run.scene["particles"]]
    force = run.scene.get("body_force", [0, 0])
    if run.scene.get("bodies") or run.scene.get("openings") or run.dimension != 2 or len(run.times) == 0:
        return None
    if not all(boxes) or any(box.get("angle", 0) for box in boxes) or not all(map(_is_number, force)):
        return None
    sides = [(np.array(box["low"], float), np.array(box["high"], float)) for box in boxes]
    if not all(_is_free(box, sides[:k] + [run.box], run) for k, box in enumerate(sides)):
        return None
    motions = [_linear_velocity(run, *box) for box in sides]
    if not all(motion is not None for motion in motions):
        return None
    corners = [np.array(list(product(*zip(*box)))) for box in sides]
    speeds = [np.column_stack([np.ones(4), each]) @ motion for each, motion in zip(corners, motions)]
    return {"start": np.concatenate(corners).tolist(), "velocity": np.concatenate(speeds).tolist(),
            "acceleration": [float(each) for each in force]}


def _is_free(box: tuple[np.ndarray, np.ndarray], others: list[tuple[np.ndarray, np.ndarray]], run: Run) -> bool:
    """Half a cell from the walls, which are the last of the others, and from all other boxes."""
    low, high = box
    near, (*regions, room) = 0.5 * run.spacing, others
    inside = np.all(low > room[0] + near) and np.all(high < room[1] - near)
    return bool(inside) and all(np.any((low > other[1] + near) | (high < other[0] - near)) for other in regions)


def _linear_velocity(run: Run, low: np.ndarray, high: np.ndarray) -> np.ndarray | None:
    """Coefficients of v = (1, x, y) c in a box at the start, 3 x 2; None if v is not linear, or zero."""
    start = run.frame(0)
    if "velocity" not in start.columns:
        return None
    inside = np.all((start.position > low) & (start.position < high), axis=1)
    velocity, basis = start.velocity[inside], np.column_stack([np.ones(inside.sum()), start.position[inside]])
    if start.time > 0 or len(basis) < 4 or not np.any(velocity):
        return None
    fit = np.linalg.lstsq(basis, velocity, rcond=None)[0]
    return fit if np.allclose(basis @ fit, velocity, atol=1e-6 * np.abs(velocity).max()) else None
