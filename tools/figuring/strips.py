"""Picture strips: the particles of one or several runs at some times."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.colors import BoundaryNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from figuring.fields import SIGNED, Field
from figuring.layout import LARGEST_PANEL, WIDTH, Margins, Sheet
from figuring.panels import REFERENCE_COLOURS, Look, draw_panel, reference_colours
from figuring.views import Slice, View, place, plane_of, view_of
from reporting.references import Curves, corners_at
from reporting.runs import NoResults, Run, labels

MOST_IN_A_ROW = 4  # of one run; more go into several rows


@dataclass(frozen=True)
class Strip:
    """What a picture strip shows."""

    runs: list[Run]
    times: list[float]  # [s]
    field: Field
    references: Sequence[Curves] = ()
    corners: bool = False
    cut: Slice | None = None
    across: int = MOST_IN_A_ROW  # panels, of one run; one alone is as wide as the page
    part: View | None = None  # what is shown of the picture plane; without it all that view_of() finds


@dataclass(frozen=True)
class Cell:
    """What a panel of a strip shows."""

    run: Run
    time: float  # [s]
    index: int | None  # of the frame, if there is one at that time


def draw_strip(strip: Strip) -> Figure:
    """One run: its times in rows. Several: a row per run, a column per time. One colour scale."""
    for time in strip.times:
        check_time(strip.runs, time)
    rows = _rows(strip)
    cells = [cell for row in rows for cell in row]
    norm, extend = scale(strip.field, [(cell.run, cell.index) for cell in cells if cell.index is not None], strip.cut)
    look = Look(strip.field, norm, strip.cut, strip.references, strip.corners)
    views = {id(run): strip.part or view_of(run, _in_the_box_of(run, strip, cells), strip.cut)
             for run in strip.runs}
    sheet = Sheet([[views[id(cell.run)] for cell in row] for row in rows], _margins(strip, rows),
                  (WIDTH, LARGEST_PANEL[1]) if strip.across == 1 else LARGEST_PANEL)
    for row, axes in zip(rows, sheet.panels):
        for cell, panel in zip(row, axes):
            draw_panel(panel, look, cell.run, cell.index, cell.time, views[id(cell.run)])
    _name_columns(strip, sheet.panels)
    if len(strip.runs) > 1:
        sheet.name_rows(labels(strip.runs))
    sheet.add_colour_bar(strip.field, norm, extend)
    sheet.add_legend(_lines(strip))
    sheet.settle()
    return sheet.figure


def index_at(run: Run, time: float) -> int | None:
    """The frame at a time; output times are hit to a time step."""
    index = int(np.argmin(np.abs(run.times - time)))
    return index if abs(run.times[index] - time) <= 2e-3 * float(run.times[-1]) else None


def check_time(runs: list[Run], time: float) -> None:
    """At least one of the runs must have a frame then."""
    if any(index_at(run, time) is not None for run in runs):
        return
    run = max(runs, key=lambda run: run.times[-1])
    first, last = run.times[0], run.times[-1]
    if not first <= time <= last:
        raise NoResults(f"{run.folder}: t = {time:g} s is outside the run; expected: between {first:g} and {last:g} s; "
                        f"nearest: {first if time < first else last:.6g} s")
    near = sorted(run.times[np.argsort(np.abs(run.times - time))[:2]])
    raise NoResults(f"{run.folder}: no frame at t = {time:g} s; nearest: {' and '.join(f'{t:.6g}' for t in near)} s")


def _rows(strip: Strip) -> list[list[Cell]]:
    cells = [[Cell(run, time, index_at(run, time)) for time in strip.times] for run in strip.runs]
    if len(cells) > 1:
        return cells
    count = -(-len(strip.times) // strip.across)
    across = -(-len(strip.times) // count)
    return [cells[0][k:k + across] for k in range(0, len(strip.times), across)]


def _in_the_box_of(run: Run, strip: Strip, cells: list[Cell]) -> list[np.ndarray]:
    """All points to be shown of runs with the same box, so that their pictures have the same view. [m]"""
    points = [cell.run.columns(cell.index)["position"] for cell in cells
              if cell.index is not None and np.array_equal(cell.run.box, run.box)]
    return points + [corners_at(run, time) for time in strip.times] if strip.corners else points


def scale(shown: Field, frames: list[tuple[Run, int]], cut: Slice | None) -> tuple[Normalize, str]:
    """Colours for these frames, and the ends at which the bar has arrows for the few particles beyond.

    From 0 on; of what has a sign the same on both sides of 0.
    """
    if shown.classes:
        count = len(shown.classes)
        return BoundaryNorm(np.arange(count + 1) - 0.5, count), "neither"
    values = np.concatenate([_values(shown, run, run.columns(index), cut) for run, index in frames])
    values = values[np.isfinite(values)]
    if len(values) == 0:  # nothing near the slice, or nothing that is a number
        return Normalize(0, 1), "neither"
    low, high = np.percentile(values, [0.5, 99.5])
    if shown.colours == SIGNED:
        high = max(abs(low), abs(high))
        low = -high
    low = 0.0 if 0 > low > -0.05 * abs(high) or low >= 0 else low
    ticks = MaxNLocator(6).tick_values(low, high if high > low else low + 1)
    low = 0.0 if low == 0 else ticks[0]
    beyond = (values.min() < low - 0.02 * (ticks[-1] - low), values.max() > ticks[-1])
    extend = {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}[beyond]
    return Normalize(low, ticks[-1]), extend


def _values(shown: Field, run: Run, columns: dict[str, np.ndarray], cut: Slice | None) -> np.ndarray:
    return shown.values(columns)[place(run, columns["position"], cut)[1]]


def _margins(strip: Strip, rows: list[list[Cell]]) -> Margins:
    in_space = all(plane_of(run, strip.cut) is None for run in strip.runs)
    return Margins(left=0.15 if in_space else 0.5, bottom=0.12 if in_space else 0.42,
                   down=0.1 if len(strip.runs) > 1 or len(rows) == 1 else 0.3)


def _name_columns(strip: Strip, panels: list[list]) -> None:
    decimals = max(len(f"{time:.4g}".partition(".")[2]) for time in strip.times)
    named = [panels[0]] if len(strip.runs) > 1 else panels
    cut = f"${strip.cut.name[0]}$ {strip.cut.name[2:]}, " if strip.cut else ""
    for panel, time in zip([panel for row in named for panel in row], strip.times):
        panel.set_title(f"{cut}$t$ = {time:.{decimals}f} s", fontsize=9, pad=4)


def _lines(strip: Strip) -> list[Line2D]:
    """What the legend explains."""
    lines = [Line2D([], [], color=colour, linewidth=1.2, label=name)
             for name, colour in reference_colours(strip.references, strip.times).items()]
    if strip.corners:
        lines.append(Line2D([], [], color=REFERENCE_COLOURS[0], marker="x", linewidth=0.8, markersize=5,
                            label="path of the corners, exact"))
    return lines
