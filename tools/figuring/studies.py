"""Error against wall time of a few methods in a few studies, for readers in a hurry. A study draws all of its rows."""

from __future__ import annotations

import csv
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, NullFormatter

from figuring.plots import COLOURS


COLOURS_OF = dict(zip(("tpic", "tpic2", "flip"), COLOURS))
SCHEMES = {"tpic": "TPIC", "tpic2": "TPIC of second order", "flip": "FLIP"}
DASHES_OF = {"conforming degree=2": "-", "conforming degree=3": "--", "equal_order": ":"}
DISCRETIZATIONS = {"conforming degree=2": "conforming, degree 2 (default)", "conforming degree=3": "conforming, degree 3",
                   "equal_order": "equal order"}
# Rows of a study that are drawn: discretization as in the table, scheme.
METHODS = (("equal_order", "flip"), ("equal_order", "tpic"), ("equal_order", "tpic2"),
           ("conforming degree=3", "tpic"), ("conforming degree=3", "tpic2"), ("conforming degree=2", "tpic"))


def draw_studies(studies: dict[str, Path], width: float) -> Figure:
    """A panel per study, by title; a line per method, a mark per number of cells."""
    figure = Figure(figsize=(width, 0.46 * width), constrained_layout={"rect": (0, 0, 1, 0.87)})
    panels = figure.subplots(1, len(studies), sharey=True)
    for axes, (title, path) in zip(panels, studies.items()):
        _draw_panel(axes, title, path)
    panels[0].set_ylabel("relative error of the velocity", fontsize=9)
    figure.legend(handles=_keys(), loc="upper center", ncol=3, frameon=False, fontsize=9)
    return figure


def _look(discretization: str, scheme: str) -> dict:
    """Colour by scheme, dashes by discretization; the default is thick."""
    default = (discretization, scheme) == ("conforming degree=2", "tpic")
    return {"color": COLOURS_OF[scheme], "linestyle": DASHES_OF[discretization], "linewidth": 2.6 if default else 1.4}


def _keys() -> list[Line2D]:
    """Schemes in the upper row of the legend, discretizations in the lower one; it fills column by column."""
    schemes = [Line2D([], [], color=COLOURS_OF[name], marker="o", markersize=4.5, linestyle="none", label=label)
               for name, label in SCHEMES.items()]
    discretizations = [Line2D([], [], color="0.25", linestyle=DASHES_OF[name], label=label)
                       for name, label in DISCRETIZATIONS.items()]
    return [key for pair in zip(schemes, discretizations) for key in pair]


def _draw_panel(axes, title: str, path: Path) -> None:
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    for method in METHODS:
        points = [(float(row["wall_s"]), float(row["error"]), row["cells"]) for row in rows
                  if (row["/discretization"], row["/transfer/scheme"]) == method]
        seconds, errors, _ = zip(*points)
        axes.plot(seconds, errors, "o", markersize=4.5, **_look(*method))
        if method[1] == "flip":
            for x, y, count in points:
                axes.annotate(f"{count} cells" if x == seconds[0] else count, (x, y), (0, 6),
                              textcoords="offset points", ha="center", fontsize=8)
    axes.set_title(title, fontsize=9.5, loc="left")
    axes.set_xlabel("wall time on one thread [s]", fontsize=9)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(0.02, 10)
    axes.set_ylim(2e-5, 0.2)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100 * value:g} %"))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(color="0.92", linewidth=0.6)
    axes.tick_params(labelsize=8)
