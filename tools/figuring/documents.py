"""The pictures of the documents, and the scenes that they need."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from figuring.fields import find_field
from figuring.frontier import draw_frontier
from figuring.layout import WIDTH, png
from figuring.rest import draw_rest
from figuring.strips import Strip, draw_strip
from reporting.references import read_references
from reporting.runs import NoResults, Run

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Figure:
    """A row per scene, a column per time, coloured by speed."""

    name: str
    scenes: tuple[str, ...]
    times: tuple[float, ...]  # [s]
    reference: Path | None = None
    corners: bool = False


@dataclass(frozen=True)
class RestFigure:
    """The speed of water at rest over time, with each quadrature."""

    name: str
    scenes: dict[str, str]  # label by scene
    quadratures: tuple[str, ...]
    end: float  # [s]


INTERFOAM = ROOT / "scenes/reference/dam_break_interfoam"
INTERFOAM_OBSTACLE = ROOT / "scenes/reference/obstacle_interfoam"


@dataclass(frozen=True)
class Pictures:
    """Pictures that lie beside the scenes that they show."""

    about: str
    folder: Path
    figures: tuple[Figure | RestFigure, ...]
    studies: Path | None = None  # their tables, for frontier.png; none of them is run


DOCUMENTS = {
    "readme": Pictures("the pictures of the README", ROOT / "scenes", (
        Figure("dam_break", ("dam_break",), (0.2, 0.4, 0.6, 0.8), INTERFOAM),), ROOT / "scenes/studies"),
    "results": Pictures("the pictures of scenes/RESULTS.md that no study makes", ROOT / "scenes", (
        Figure("obstacle", ("obstacle",), (0.1, 0.2, 0.25, 0.3), INTERFOAM_OBSTACLE),
        RestFigure("rest", {"tilted_pool": "gravity 25 degrees off the grid", "tilted_tank": "tank turned by 25 degrees"},
                   ("exact", "mixed"), 60.0))),
    "paper": Pictures("the figures of the paper that scenes/paper reproduces", ROOT / "scenes/paper", (
        Figure("dam_break", ("dam_break_pic", "dam_break_flip", "dam_break_tpic"), (0.3, 0.6, 5.0), INTERFOAM),
        Figure("rotating_square", ("rotating_square_flip", "rotating_square_tpic"), (1.0, 2.0, 4.0), corners=True))),
}


def write_pictures(pictures: Pictures, scenes: Path, results: Path, out: Path) -> list[Path]:
    """Runs the scenes whose results are not there, and draws."""
    written = [_write_figure(figure, scenes, results, out) for figure in pictures.figures]
    if pictures.studies:
        written.append(out / "frontier.png")
        written[-1].write_bytes(png(draw_frontier(pictures.studies, WIDTH)))
    return written


def _write_figure(figure: Figure | RestFigure, scenes: Path, results: Path, out: Path) -> Path:
    path = out / f"{figure.name}.png"
    path.write_bytes(png(_draw_rest(figure, scenes, results) if isinstance(figure, RestFigure)
                         else _draw_scenes(figure, scenes, results)))
    return path


def _draw_rest(figure: RestFigure, scenes: Path, results: Path):
    runs = {}
    results.mkdir(parents=True, exist_ok=True)
    for name, label in figure.scenes.items():
        for scheme in figure.quadratures:
            scene = _read(scenes / f"{name}.json")
            scene["time"]["end"] = figure.end
            scene["quadrature"] = {"scheme": scheme}
            changed = results / f"{name}_{scheme}.json"
            changed.write_text(json.dumps(scene))
            runs[label, scheme] = _run(changed, results / changed.stem)
    return draw_rest(runs, WIDTH)


def _draw_scenes(figure: Figure, scenes: Path, results: Path):
    runs = [_run(scenes / f"{name}.json", results / name) for name in figure.scenes]
    references = read_references(figure.reference) if figure.reference else []
    return draw_strip(Strip(runs, list(figure.times), find_field(runs, "speed"), references, figure.corners))


def _read(scene: Path) -> dict[str, Any]:
    if not scene.is_file():
        raise NoResults(f"{scene}: no such scene")
    return json.loads(scene.read_text())


def _run(scene: Path, folder: Path) -> Run:
    there = _is_there(_read(scene), folder)
    if there is None or not there.summary.get("complete", False):
        program = os.environ.get("MINAMO")
        command = [program, "run"] if program else [str(ROOT / "tools/run")]
        # What was begun and is this very scene goes on; what else is unfinished there minamo does not replace.
        more = ["--resume"] if there and (folder / "checkpoint.h5").is_file() else []
        status = subprocess.run([*command, str(scene), "--out", str(folder), *more], check=False).returncode
        if status != 0:
            sys.exit(status)  # minamo has said why
    return Run(folder)


def _is_there(scene: dict[str, Any], folder: Path) -> Run | None:
    """The run of this very scene in the folder, finished or not, if there is one."""
    if not (folder / "scene.json").is_file():
        return None
    run = Run(folder)
    return run if _contains(run.scene, scene) else None


def _contains(whole: Any, part: Any) -> bool:
    """The scene as it ran has all that the file says, and the defaults."""
    if isinstance(part, dict):
        return isinstance(whole, dict) and all(key in whole and _contains(whole[key], part[key]) for key in part)
    if isinstance(part, list):
        return isinstance(whole, list) and len(whole) == len(part) and all(map(_contains, whole, part))
    return whole == part
