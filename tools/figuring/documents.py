"""The pictures of the documents, and the scenes that they need."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from figuring.fields import find_field
from figuring.frontier import draw_frontier
from figuring.gallery import GALLERY, Exhibit, draw_exhibit, picture_of
from figuring.layout import WIDTH, png
from figuring.rest import draw_rest
from figuring.scene_runs import ROOT, read_scene, run_of
from figuring.strips import Strip, draw_strip
from reporting.references import read_references


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
    """Pictures that lie next to the scenes that they show."""

    about: str
    folder: Path
    figures: tuple[Figure | RestFigure | Exhibit, ...]
    studies: Path | None = None  # their tables, for frontier.png; none of them is run
    beside: str = "."  # where the pictures lie, from the folder of the scenes


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
    "gallery": Pictures("the pictures of scenes/GALLERY.md", ROOT / "scenes", GALLERY, beside="gallery"),
}


def write_pictures(pictures: Pictures, scenes: Path, results: Path, out: Path) -> list[Path]:
    """Runs the scenes whose results are not there, and draws."""
    written = [_write_figure(figure, scenes, results, out) for figure in pictures.figures]
    if pictures.studies:
        written.append(out / "frontier.png")
        written[-1].write_bytes(png(draw_frontier(pictures.studies, WIDTH)))
    return written


def _write_figure(figure: Figure | RestFigure | Exhibit, scenes: Path, results: Path, out: Path) -> Path:
    path = out / f"{figure.name}.png"
    if isinstance(figure, Exhibit):
        run = run_of(scenes / f"{figure.scene}.json", results / figure.name, figure.settings)
        path.write_bytes(picture_of(draw_exhibit(figure, run, ROOT / "scenes/reference")))
    else:
        path.write_bytes(png(_draw_rest(figure, scenes, results) if isinstance(figure, RestFigure)
                             else _draw_scenes(figure, scenes, results)))
    return path


def _draw_rest(figure: RestFigure, scenes: Path, results: Path):
    runs = {}
    results.mkdir(parents=True, exist_ok=True)
    for name, label in figure.scenes.items():
        for scheme in figure.quadratures:
            scene = read_scene(scenes / f"{name}.json")
            scene["time"]["end"] = figure.end
            scene["quadrature"] = {"scheme": scheme}
            changed = results / f"{name}_{scheme}.json"
            changed.write_text(json.dumps(scene))
            runs[label, scheme] = run_of(changed, results / changed.stem)
    return draw_rest(runs, WIDTH)


def _draw_scenes(figure: Figure, scenes: Path, results: Path):
    runs = [run_of(scenes / f"{name}.json", results / name) for name in figure.scenes]
    references = read_references(figure.reference) if figure.reference else []
    return draw_strip(Strip(runs, list(figure.times), find_field(runs, "speed"), references, figure.corners))
