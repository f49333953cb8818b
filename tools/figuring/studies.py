"""Error against wall time of a few schemes in a few studies, for readers in a hurry. A study draws all of its rows."""

from __future__ import annotations

import csv
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter

from figuring.plots import COLOURS

SCHEMES = {"pic": "PIC", "flip": "FLIP", "tpic": "TPIC", "tpic2": "TPIC of second order (default)"}


def draw_studies(studies: dict[str, Path], width: float) -> Figure:
    """A panel per study, by title; a line per scheme with the midpoint rule, a mark per number of cells."""
    figure = Figure(figsize=(width, 0.42 * width), constrained_layout={"rect": (0, 0, 1, 0.91)})
    panels = figure.subplots(1, len(studies), sharey=True)
    for axes, (title, path) in zip(panels, studies.items()):
        _draw_panel(axes, title, path)
    panels[0].set_ylabel("relative error of the velocity", fontsize=9)
    figure.legend(*panels[0].get_legend_handles_labels(), loc="upper center", ncol=len(SCHEMES), frameon=False,
                  fontsize=9)
    return figure


def _draw_panel(axes, title: str, path: Path) -> None:
    with path.open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["/integrator/scheme"] == "midpoint"]
    for colour, (scheme, name) in zip(COLOURS, SCHEMES.items()):
        points = [(float(row["wall_s"]), float(row["error"]), row["cells"]) for row in rows
                  if row["/transfer/scheme"] == scheme]
        seconds, errors, cells = zip(*points)
        axes.plot(seconds, errors, "o-", color=colour, label=name, linewidth=1.4, markersize=4.5)
        if scheme == "pic":
            for x, y, count in points:
                axes.annotate(f"{count} cells" if x == seconds[0] else count, (x, y), (0, 6),
                              textcoords="offset points", ha="center", fontsize=8)
    axes.set_title(title, fontsize=9.5, loc="left")
    axes.set_xlabel("wall time on one thread [s]", fontsize=9)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(0.02, 10)
    axes.set_ylim(2e-5, 3)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100 * value:g} %"))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(color="0.92", linewidth=0.6)
    axes.tick_params(labelsize=8)
