"""Pictures of runs in 3-D as water in a tank, rendered by Blender from the surfaces of their frames."""

from __future__ import annotations

import json
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from figuring.smoothing import smooth
from figuring.strips import check_time, index_at
from reporting.bodies import bodies_of
from reporting.runs import NoResults, Run
from reporting.surfaces import surface_file, surface_of

IN_BLENDER = Path(__file__).parent / "in_blender.py"


@dataclass(frozen=True)
class Rendering:
    """How pictures are made."""

    size: tuple[int, int]  # pixels
    samples: int  # rays per pixel
    eye: tuple[float, float]  # how far to the right of the front and above the floor it is [degrees]


def render(run: Run, times: list[float] | None, how: Rendering, out: Path) -> list[Path]:
    """A picture per frame, or of those at some times."""
    if run.dimension != 3:
        raise NoResults(f"{run.folder}: --render shows runs in 3-D, this one is in 2-D")
    frames = list(range(len(run.times))) if times is None else [_frame_at(run, time) for time in times]
    for frame in frames:
        surface_file(run, frame)
    _check_blender()
    out.mkdir(parents=True, exist_ok=True)
    pictures = [out.resolve() / f"render_{frame:04}.png" for frame in frames]
    with tempfile.TemporaryDirectory() as name:
        settings = {"box": _upright(run, np.array(run.box)).tolist(), "eye": how.eye, "size": how.size,
                    "samples": how.samples, "pictures": [_shown(run, frame, picture, Path(name))
                                                         for frame, picture in zip(frames, pictures)]}
        path = Path(name) / "settings.json"
        path.write_text(json.dumps(settings))
        done = subprocess.run(["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python",
                               str(IN_BLENDER), "--", str(path)], capture_output=True, text=True, check=False)
    if done.returncode != 0 or not all(picture.is_file() for picture in pictures):
        raise NoResults(f"blender ended with {done.returncode}:\n{(done.stdout + done.stderr)[-2000:]}")
    return pictures


def _check_blender() -> None:
    if not shutil.which("blender"):
        raise NoResults("blender, which renders, is not installed: sudo apt-get install blender")


def _shown(run: Run, frame: int, picture: Path, folder: Path) -> dict:
    """What Blender needs for a picture."""
    surface = smooth(surface_of(run, frame), *run.box)
    water = folder / f"{frame:04}.npz"
    np.savez(water, points=_upright(run, surface.points), triangles=surface.elements)
    bodies = [[_upright(run, body.points_at(frame)).tolist(), body.elements.tolist()] for body in bodies_of(run)]
    return {"water": str(water), "picture": str(picture), "bodies": bodies}


def _upright(run: Run, points: np.ndarray) -> np.ndarray:
    """Turned so that the last axis is upward."""
    return np.roll(points, 2 - run.up, axis=1)


def _frame_at(run: Run, time: float) -> int:
    frame = index_at(run, time)
    if frame is None:
        check_time([run], time)
    return frame
