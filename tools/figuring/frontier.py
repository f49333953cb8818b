"""Error against processor time of minamo and of others, for the front page: a panel per study, which nothing here runs."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from figuring.plots import COLOURS

GREY = "0.42"
MARKS_OF = {"MLS-MPM": "x", "apic2d": "+", "interFoam": "s"}


@dataclass(frozen=True)
class Line:
    """The rows of a study that have these values, over its number of cells."""

    label: str
    values: dict[str, str]
    look: dict


@dataclass(frozen=True)
class Panel:
    title: str
    study: str  # name of its tables in scenes/studies
    error: str  # label of the axis
    others: dict[str, str]  # label by code
    lines: tuple[Line, ...]


def _per_cell(count: int, cfl: int, **look) -> Line:
    values = {"/particles/0/per_cell": str(count), "/time/cfl": str(cfl)}
    more = ", CFL 2" if cfl == 2 else " (default)" if count == 3 else ""
    return Line(f"minamo, {count} x {count} a cell{more}", values, look)


def _discretization(label: str, name: str, **look) -> Line:
    return Line(f"minamo, {label}", {"/discretization": name, "/particles/0/per_cell": "4", "courant": "1.6"}, look)


PANELS = (
    Panel("Dam break", "dam_break", "water misplaced, next to interFoam 160 x 160",
          {"MLS-MPM": "MLS-MPM, explicit", "apic2d": "apic2d, projection", "interFoam": "interFoam, volume of fluid"}, (
              _per_cell(3, 1, color=COLOURS[0], linewidth=2.6),
              _per_cell(4, 1, color=COLOURS[1]),
              _per_cell(2, 1, color=COLOURS[2]),
              _per_cell(4, 2, color=COLOURS[1], linestyle="--"))),
    Panel("Disc stretched to an ellipse", "elliptical_drop", "relative error of the velocity",
          {"MLS-MPM": "MLS-MPM", "apic2d": "apic2d"}, (
              _discretization("default", "conforming degree=2", color=COLOURS[0], linewidth=2.6),
              _discretization("degree 3", "conforming degree=3", color=COLOURS[1]),
              _discretization("equal order", "equal_order", color=COLOURS[2]))))


def draw_frontier(studies: Path, width: float) -> Figure:
    """`studies` has NAME_frontier.csv, as `minamo study` writes it, and NAME_others.csv."""
    figure = Figure(figsize=(width, 0.5 * width), constrained_layout=True)
    for axes, panel in zip(figure.subplots(1, len(PANELS)), PANELS):
        _draw_panel(axes, panel, studies)
    return figure


def _rows(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def _draw_panel(axes, panel: Panel, studies: Path) -> None:
    rows = _rows(studies / f"{panel.study}_frontier.csv")
    for line in panel.lines:
        points = sorted((int(row["cells"]), float(row["cpu_per_s"]), float(row["error"])) for row in rows
                        if all(row[key] == value for key, value in line.values.items()))
        cells, seconds, errors = zip(*points)
        axes.plot(seconds, errors, marker="o", markersize=4, **{"linewidth": 1.4, "label": line.label} | line.look)
        if line is panel.lines[0]:
            for place, side, shift in ((0, "left", (7, 1)), (-1, "left", (6, 3))):
                axes.annotate(f"{cells[place]} cells", (seconds[place], errors[place]), shift,
                              textcoords="offset points", ha=side, fontsize=7.5, color=COLOURS[0])
    for code, label in panel.others.items():
        points = [(float(row["cost"]), float(row["error"])) for row in _rows(studies / f"{panel.study}_others.csv")
                  if row["code"] == code]
        axes.plot(*zip(*points), linestyle="none", marker=MARKS_OF[code], markersize=6.5, markeredgewidth=1.6,
                  color=GREY, markerfacecolor="none", label=label)
    _dress(axes, panel)


def _dress(axes, panel: Panel) -> None:
    axes.set_title(panel.title, fontsize=9.5, loc="left")
    axes.set_xlabel("processor time of a simulated second [s]", fontsize=9)
    axes.set_ylabel(panel.error, fontsize=9)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100 * value:g} %"))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(color="0.92", linewidth=0.6)
    axes.tick_params(labelsize=8)
    axes.legend(loc="best", frameon=False, fontsize=7.5)
