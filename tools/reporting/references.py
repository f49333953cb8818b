"""What particles are compared with in pictures: lines from files, and where corners of liquid must be."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np

from reporting.runs import NoResults, Run


@dataclass(frozen=True)
class Curves:
    """Lines of a reference at one time."""

    name: str
    time: float  # [s]
    segments: list[np.ndarray]  # [m], points x 2


def read_references(folder: Path) -> list[Curves]:
    """All NAME_tT.csv of a folder: lines at time T, rows of `segment,x,y`; underscores of NAME are shown as blanks."""
    found = []
    for path in sorted(folder.glob("*_t*.csv")):
        if match := re.fullmatch(r"(.*)_t([0-9]+\.?[0-9]*)", path.stem):
            found.append(Curves(match[1].replace("_", " "), float(match[2]), _segments(path)))
    if not found:
        raise NoResults(f"{folder}: no reference here; expected: files NAME_tT.csv with the columns segment,x,y")
    return found


def _segments(path: Path) -> list[np.ndarray]:
    segments: dict[str, list[tuple[float, float]]] = {}
    with path.open(newline="") as file:
        for row in csv.DictReader(file):
            segments.setdefault(row["segment"], []).append((float(row["x"]), float(row["y"])))
    return [np.array(points) for points in segments.values()]


def corners_at(run: Run, time: float) -> np.ndarray:
    """Where the corners of the boxes of liquid are that no wall touches. [m]

    At a corner two free surfaces meet, the pressure gradient vanishes, the liquid goes on as it started: x + t v(x).
    For a square of side L that rotates at the rate w: (L/2) (1 - wt, 1 + wt) and its turned copies.
    """
    boxes = [region["shape"]["box"] for region in run.scene["particles"] if "box" in region["shape"]]
    if not boxes or run.dimension != 2:
        raise NoResults(f"{run.folder}: no box of liquid in 2-D, so no corners to mark")
    start = run.frame(0)
    basis = np.column_stack([np.ones(len(start.position)), start.position])
    fit = np.linalg.lstsq(basis, start.velocity, rcond=None)[0]  # v at the start is linear in x
    corners = np.array([corner for box in boxes for corner in product(*zip(box["low"], box["high"]))])
    return corners + time * np.column_stack([np.ones(len(corners)), corners]) @ fit
