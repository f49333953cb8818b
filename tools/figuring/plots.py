"""Curves of history.csv over time, and what the time of a run went to."""

from __future__ import annotations

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator, NullFormatter, ScalarFormatter

from figuring.labels import box_of, fitting_legend, wrapped
from reporting.histories import Plot, plots
from reporting.runs import Run, labels

COLOURS = 3 * ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")  # told apart by all eyes
BESIDE_TITLE = 0.6  # of a column of panels: numbers of the axis, and the gap between columns [inch]
STYLES = ("solid", (0, (4, 1.5)), (0, (1, 1)))


def draw_history(runs: list[Run], width: float = 10.0, across: int = 3) -> Figure | None:
    """A panel per quantity, a colour per run."""
    shown = plots([run for run in runs if run.history])
    if not shown:
        return None
    down = -(-len(shown) // across)
    titles = [_title(panel, width / across - BESIDE_TITLE) for panel in shown]
    broken = sum(max(title.count("\n") for title in titles[k:k + across]) for k in range(0, len(titles), across))
    figure = empty_page(runs, width, 1.9 * down + 0.2 + 0.15 * broken)
    axes = figure.subplots(down, across, squeeze=False).flatten()
    for place, panel, title in zip(axes, shown, titles):
        _draw_panel(place, panel, runs)
        place.set_title(title, fontsize=9.5, loc="left")
    for place in axes[len(shown):]:
        place.set_axis_off()
    for place in axes[across * (down - 1):]:
        place.set_xlabel("$t$ [s]", fontsize=9)
    return figure


def _title(panel: Plot, width: float) -> str:
    """In lines within a column of panels. [inch]"""
    return wrapped(panel.title + (f" [{panel.unit}]" if panel.unit else ""), width, 9.5)


def empty_page(runs: list[Run], width: float, height: float) -> Figure:
    """Empty, with a legend of several runs above, which the height is without. [inch]"""
    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    head = 0.0
    if len(runs) > 1:
        lines = [Line2D([], [], color=colour, linewidth=1.6) for colour in COLOURS[:len(runs)]]
        head = box_of(fitting_legend(figure, lines, labels(runs), 10, loc="upper center")).height
        figure.set_figheight(height + head)
    figure.set_layout_engine("constrained", rect=(0, 0, 1, 1 - head / (height + head)), h_pad=0.08)
    return figure


def _draw_panel(axes, panel: Plot, runs: list[Run]) -> None:
    for k, run in enumerate(runs):
        for j, (column, name) in enumerate(panel.columns.items()):
            values = run.series(column)
            if values is not None:
                axes.plot(run.history["time"], values, linestyle=STYLES[j], label=name, linewidth=0.8,
                          color=COLOURS[k if len(runs) > 1 else j])
    quiet(axes)
    _logarithmic(axes) if panel.logarithmic else linear(axes)
    if any(panel.columns.values()):
        axes.legend(fontsize=8, frameon=False, handlelength=1.8, borderaxespad=0.1)


def _logarithmic(axes) -> None:
    """Whole decades."""
    values = np.concatenate([line.get_ydata() for line in axes.get_lines()])
    values = values[values > 0]
    low, high = np.floor(np.log10(values.min())), np.ceil(np.log10(values.max()))
    axes.set_ylim(10**low, 10 ** max(high, low + 1))
    axes.set_yscale("log")
    axes.yaxis.set_minor_formatter(NullFormatter())


def linear(axes) -> None:
    axes.yaxis.set_major_locator(MaxNLocator(4))
    formatter = ScalarFormatter(useOffset=False, useMathText=True)
    formatter.set_powerlimits((-3, 4))
    axes.yaxis.set_major_formatter(formatter)
    axes.yaxis.get_offset_text().set_fontsize(8)


def quiet(axes) -> None:
    """Two axes, faint grid, small numbers."""
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(color="0.92", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.tick_params(labelsize=8, length=2.5)
    axes.margins(x=0.01)


def draw_systems(runs: list[Run], width: float = 10.0, count: int = 12) -> Figure | None:
    """Seconds per system, the dearest first, the others in one bar."""
    runs = [run for run in runs if run.summary.get("systems")]
    if not runs:
        return None
    seconds = [{row["name"]: row["seconds"] for row in run.summary["systems"]} for run in runs]
    names = sorted({name for each in seconds for name in each}, key=lambda name: -max(s.get(name, 0) for s in seconds))
    top, others = names[:count], names[count:]
    bars = [[each.get(name, 0) for name in top] + [sum(each.get(name, 0) for name in others)] for each in seconds]
    captions = top + [f"{len(others)} others"] if others else top
    return _bars(runs, [row[:len(captions)] for row in bars], captions, width)


def _bars(runs: list[Run], bars: list[list[float]], captions: list[str], width: float) -> Figure:
    captions = [wrapped(caption, 0.4 * width, 8.5, 2) for caption in captions]
    figure = empty_page(runs, width, 0.4 + len(captions) * (0.12 + 0.14 * len(runs)))
    axes = figure.subplots()
    thick = 0.8 / len(runs)
    for k, (run, row) in enumerate(zip(runs, bars)):
        places = np.arange(len(row)) + (k - 0.5 * (len(runs) - 1)) * thick
        drawn = axes.barh(places, row, 0.92 * thick, color=COLOURS[k])
        wall = run.summary["wall_s"]
        texts = [f"{value:.3g} s   {100 * value / wall:.1f} %" if value else "" for value in row]
        axes.bar_label(drawn, texts, padding=4, fontsize=8)
    axes.set_yticks(range(len(captions)), captions, fontsize=8.5)
    axes.invert_yaxis()
    axes.set_xlabel("wall time [s]", fontsize=9)
    quiet(axes)
    axes.grid(axis="y", visible=False)
    axes.margins(x=0.16, y=0.01)
    return figure
