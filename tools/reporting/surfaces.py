"""The free surface of a frame, as surface/NNNN.vtp or .ply has it."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from reporting.packing import pack_frames, pack_table
from reporting.runs import NoResults, Run


@dataclass(frozen=True)
class Surface:
    """Closed lines in 2-D, closed triangle meshes in 3-D; elements are turned outward."""

    points: np.ndarray  # [m], points x dimension
    elements: np.ndarray  # numbers of points, elements x dimension


def has_surface(run: Run, index: int) -> bool:
    """Whether the run was asked for surfaces and has written this one."""
    return _find(run, index) is not None


def surface_file(run: Run, index: int) -> Path:
    """NoResults where there is none."""
    path = _find(run, index)
    if path is None:
        raise NoResults(f"{run.folder}/surface: no surface of frame {index}; expected: that of a run with "
                        "\"output\": {\"surface\": \"ply\"}")
    return path


def surface_of(run: Run, index: int) -> Surface:
    """The surface of a frame; NoResults where there is none."""
    path = surface_file(run, index)
    try:
        points, elements = READERS[path.suffix[1:]](path.read_bytes(), run.dimension)
        if elements.size and (elements.min() < 0 or elements.max() >= len(points)):
            raise ValueError("an element has a point that is not there")
    except (AttributeError, IndexError, KeyError, ValueError) as problem:
        raise NoResults(f"{path}: cannot be read ({problem}); expected: what minamo wrote") from problem
    return Surface(points[:, :run.dimension].astype(float), elements)


def loops_of(surface: Surface) -> list[np.ndarray]:
    """In 2-D: numbers of points around each loop."""
    after = dict(surface.elements.tolist())
    loops = []
    while after:
        loop, at = [], next(iter(after))
        while at in after:
            loop.append(at)
            at = after.pop(at)
        loops.append(np.array(loop))
    return loops


def packed_surfaces(run: Run, add: Any) -> dict[str, Any] | None:
    """The loops of all frames of a run in 2-D, as the page knows them; None if it has no surface.
    `add(text)` keeps a packed column and gives the key to find it by."""
    frames = range(len(run.times))
    if run.dimension != 2 or not any(has_surface(run, frame) for frame in frames):
        return None
    points, lengths, counts = [np.empty((0, 2))], [], []
    for frame in frames:
        loops = []
        if has_surface(run, frame):
            surface = surface_of(run, frame)
            loops = [surface.points[loop] for loop in loops_of(surface)]
        points += loops
        lengths += map(len, loops)
        counts.append(len(loops))
    low, high = run.box
    places = np.concatenate(points)
    packed = [pack_frames(places[None, :, d], low[d], high[d], 16, 0) for d in range(2)]
    return {"points": [add(axis.text) for axis in packed], "lengths": add(pack_table([np.array(lengths)])),
            "loops": counts}


def _find(run: Run, index: int) -> Path | None:
    extension = run.scene.get("output", {}).get("surface")
    path = run.folder / "surface" / f"{index:04}.{extension}"  # others in the folder are of earlier runs
    return path if extension in READERS and path.is_file() else None


def _vtp(data: bytes, dimension: int) -> tuple[np.ndarray, np.ndarray]:
    head, numbers = data.split(b'<AppendedData encoding="raw">\n_', 1)

    def array(name: str, kind: str) -> np.ndarray:
        at = int(re.search(rf'Name="{name}"[^>]*offset="(\d+)"', head.decode()).group(1))
        size = int(np.frombuffer(numbers, "<u8", 1, at)[0])
        return np.frombuffer(numbers[at + 8:at + 8 + size], kind)

    return array("position", "<f4").reshape(-1, 3), array("connectivity", "<i4").reshape(-1, dimension)


def _ply(data: bytes, dimension: int) -> tuple[np.ndarray, np.ndarray]:
    head, numbers = data.split(b"end_header\n", 1)
    count = {name: int(n) for name, n in re.findall(r"element (\w+) (\d+)", head.decode())}
    width = head.count(b"property float")
    points = np.frombuffer(numbers, "<f4", width * count["vertex"]).reshape(-1, width)
    # A triangle has its number of corners before them.
    row = np.dtype([("corners", "<i4", 2)] if dimension == 2 else [("number", "u1"), ("corners", "<i4", 3)])
    rows = np.frombuffer(numbers, row, count["edge" if dimension == 2 else "face"], 4 * width * count["vertex"])
    return points[:, :3], rows["corners"]


READERS = {"vtp": _vtp, "ply": _ply}  # by "/output/surface" of the scene
