"""report.html: one file with everything in it. Its sources are in page/, what is packed into them comes from here."""

from __future__ import annotations

import json
import re
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from reporting.bodies import bodies_of, packed_bodies
from reporting.facts import balance_section, comparison_section, facts_list, headline, messages, scene_files
from reporting.graph import describe, draw_graph
from reporting.histories import Plot, packed_history, plots
from reporting.overlays import corner_paths, references, walls
from reporting.particles import Particles
from reporting.profile import profile_section
from reporting.runs import Run, labels, telling_times
from reporting.shading import surface_section
from reporting.surfaces import packed_surfaces

SOURCES = Path(__file__).resolve().parent / "page"
STYLES = ("vendor/uPlot.min.css", "page.css")
SCRIPTS = ("vendor/uPlot.iife.min.js", "data.js", "bodies.js", "surfaces.js", "colours.js", "camera.js", "painter.js",
           "drawing.js", "panel.js", "colour_bar.js", "player.js", "strip.js", "plots.js", "systems.js", "theme.js",
           "app.js")
# Particles times frames of a page, by dimension: about 30 MB at the 5 and 9 bytes that violent flows need for each.
MOST_SAMPLES = {2: 5_000_000, 3: 3_000_000}
STRIP_LENGTH = 8  # pictures


class Packer:
    """Keeps packed columns, and gives keys to find them by in the page."""

    def __init__(self) -> None:
        self.texts: list[str] = []

    def add(self, text: str) -> int:
        self.texts.append(text)
        return len(self.texts) - 1

    def html(self) -> str:
        return "\n".join(f"<script type=\"application/octet-stream\" id=\"packed-{key}\">{text}</script>"
                         for key, text in enumerate(self.texts))


def write_page(path: Path, runs: list[Run], times: list[float] | None, program: Path | None) -> None:
    """Writes the page on these runs; `times` [s] are those of the strip, `program` draws the graph of the systems."""
    packer, shown = Packer(), plots([run for run in runs if run.history])
    frames = max(1, sum(len(run.times) for run in runs))
    particles = [Particles.read(run, MOST_SAMPLES[run.dimension] // frames) for run in runs]
    described = [{"label": label, "view": view} | _described(run, each, shown, packer)
                 for run, label, view, each in zip(runs, labels(runs), _views(runs, particles), particles)]
    report = {"runs": described, "plots": [plot.as_json() for plot in shown],
              "strip": _strip_times(described, runs, times)}
    title = runs[0].title if len(runs) == 1 else "Comparison: " + ", ".join(labels(runs))
    beside = facts_list(runs[0]) if len(runs) == 1 else ""
    page = _filled("template.html", {
        "title": escape(title), "headlines": "\n".join(map(headline, runs)), "messages": messages(runs),
        "style": "\n".join(_source(name) for name in STYLES), "script": "\n".join(_source(name) for name in SCRIPTS),
        "particles": _particles_section(described, beside) if any(particles) else beside,
        "histories": _histories_section(described) if shown else "",
        "sections": "\n".join([*(surface_section(run, report["strip"]) for run in runs),
                               comparison_section(runs) if len(runs) > 1 else "", balance_section(runs),
                               profile_section(runs), _graph_section(runs, program), scene_files(runs)]),
        "footer": "Written by tools/report of minamo. Plots by uPlot, MIT licence.",
        "report": json.dumps(report, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c"),
        "packed": packer.html(),
    })
    path.write_text(page, encoding="utf-8")


def _source(name: str) -> str:
    return (SOURCES / name).read_text(encoding="utf-8")


def _filled(name: str, parts: dict[str, str]) -> str:
    """A source with {{name}} replaced."""
    return re.sub(r"\{\{(\w+)\}\}", lambda match: parts[match[1]], _source(name))


def _described(run: Run, particles: Particles | None, shown: list[Plot], packer: Packer) -> dict[str, Any]:
    """What the page knows of a run on its own."""
    low, high = run.box
    sides = walls(run.scene.get("walls", "slip"), run.dimension)
    return {
        "dimension": run.dimension, "up": run.up, "spacing": run.spacing,
        "particle_size": run.particle_size, "box": {"low": low.tolist(), "high": high.tolist()},
        "walls": sides, "periodic": any("periodic" in each for each in sides), "times": run.times.tolist(),
        "particles": particles.packed(packer.add) if particles else None,
        "bodies": packed_bodies(bodies_of(run), packer.add),
        "surfaces": packed_surfaces(run, packer.add), "references": references(run), "corners": corner_paths(run),
        "history": packed_history(run, shown, packer.add),
    }


def _views(runs: list[Run], particles: list[Particles | None]) -> list[list[list[float]]]:
    """Low and high corner of what is shown, by run, the same for all runs in the same box. [m]"""
    boxes = [run.box for run in runs]
    reaches = [None if each is None else each.reach for each in particles]
    return [_view(run, [reach for other, reach in zip(boxes, reaches) if reach and np.array_equal(other, box)])
            for run, box in zip(runs, boxes)]


def _view(run: Run, reaches: list[tuple[np.ndarray, np.ndarray]]) -> list[list[float]]:
    """The box, or, in 2-D, without bodies and far from all walls, the reach of the liquid."""
    low, high = run.box
    if reaches and run.dimension == 2 and not run.scene.get("bodies"):
        least = np.min([reach[0] for reach in reaches], axis=0)
        most = np.max([reach[1] for reach in reaches], axis=0)
        near, margin = 3 * run.spacing, 0.05 * (most - least).max()
        if np.all(least > low + near) and np.all(most < high - near):
            low, high = least - margin, most + margin
    return [low.tolist(), high.tolist()]


def _strip_times(described: list[dict[str, Any]], runs: list[Run], wanted: list[float] | None) -> list[float]:
    """Output times of the run that goes farthest: next to those wanted, or of a reference, or telling ones."""
    farthest = max(range(len(runs)), key=lambda k: runs[k].times[-1] if len(runs[k].times) else -1.0)
    times = runs[farthest].times
    if len(times) == 0:
        return []
    if wanted:
        return sorted({float(times[abs(times - time).argmin()]) for time in wanted})
    compared = {float(times[abs(times - curves["time"]).argmin()]) for curves in described[farthest]["references"]
                if abs(times - curves["time"]).min() < 2e-3 * times[-1]}
    return sorted(compared)[:STRIP_LENGTH] if len(compared) > 2 else telling_times(runs[farthest], STRIP_LENGTH)


def _histories_section(described: list[dict[str, Any]]) -> str:
    text = "Point at a plot for its values, click to go to a time, drag over a span to zoom, double click to zoom out."
    for run in described:
        if run["history"] and run["history"]["every"] > 1:
            text += f" {run['label']}: the page has one of {run['history']['every']} steps."
    return f"<h2>History</h2><div id=\"plots\"></div><p class=\"soft\">{escape(text)}</p>"


def _particles_section(described: list[dict[str, Any]], beside: str) -> str:
    return _filled("particles.html", {"stored": escape(_stored(described)), "facts": beside})


def _stored(described: list[dict[str, Any]]) -> str:
    """How exact the numbers of the page are."""
    shown = [run for run in described if run["particles"]]
    step = max(run["particles"]["position"]["step"] for run in shown)
    bits = {field["bits"] for run in shown for field in run["particles"]["fields"]}
    text = (f"Positions are stored to {1e3 * step:.2g} mm (16 bits over their range), other quantities in {max(bits)} "
            "bits over their range; fields.h5 has the exact numbers. Between output times positions are interpolated "
            "while the page plays; a still picture always shows an output time.")
    for run in shown:
        if run["particles"]["share"] < 1:
            text += (f" {run['label']}: the page has {100 * run['particles']['share']:.3g} % of the particles, chosen "
                     "at random and drawn larger; ranges are those of all particles.")
    if any(run["particles"]["changes"] for run in shown):
        text += " Particles that come in or leave between two output times move on evenly from the time that has them."
    return text


def _graph_section(runs: list[Run], program: Path | None) -> str:
    """The graph of the first run, and in words what every system reads and writes; else why there is none."""
    drawing = draw_graph(runs[0], program)
    of_which = f": {escape(labels(runs)[0])}" if len(runs) > 1 else ""
    parts = [f"<h2>Systems of a step{of_which}</h2><figure id=\"graph\">"]
    if drawing.svg:
        parts.append("<p class=\"soft\">An arrow leads to a system that waits for the data of another. Warmer colours "
                     "are larger shares of the time. Click a system for its data.</p><pre hidden></pre>"
                     f"<div class=\"wide\">{drawing.svg}</div>")
    if drawing.sentence:
        parts.append(f"<p>{escape(drawing.sentence)}</p>")
    if drawing.systems:
        text = "\n\n".join(describe(system).replace("\n", "\n  ") for system in drawing.systems)
        parts.append(f"<details><summary>{len(drawing.systems)} systems, what they read and write</summary>"
                     f"<pre>{escape(text)}</pre></details>")
    return "".join([*parts, "</figure>"])
