"""compare.png: particles side by side, histories over each other, their differences below."""

from __future__ import annotations

import io

import numpy as np
from matplotlib.figure import Figure
from matplotlib.image import imread, imsave

from comparing.comparison import Comparison
from comparing.histories import difference_over_time, samples
from figuring.fields import find_field, usual_fields
from figuring.labels import wrapped
from figuring.layout import WIDTH, Margins, Sheet, png
from figuring.panels import Look, draw_panel
from figuring.plots import BESIDE_TITLE, COLOURS, empty_page, linear, quiet
from figuring.strips import scale
from figuring.views import plane_of, view_of
from reporting.runs import labels

ACROSS = 3
HIGH = 2.4  # of a history and its difference [inch]


def picture(comparison: Comparison) -> bytes:
    """As a PNG file."""
    sheets = [sheet for sheet in (_particles(comparison), _histories(comparison)) if sheet]
    images = [imread(io.BytesIO(png(sheet))) for sheet in sheets]
    width = max(image.shape[1] for image in images)
    wide = [np.pad(image, ((0, 0), (0, width - image.shape[1]), (0, 0)), constant_values=1) for image in images]
    file = io.BytesIO()
    imsave(file, np.concatenate(wide), format="png", pil_kwargs={"optimize": True})
    return file.getvalue()


def _particles(comparison: Comparison) -> Figure | None:
    """Of the last common frame, or of the one at the chosen time."""
    indices, runs = comparison.shown_frame, comparison.runs
    if indices is None:
        return None
    field = find_field(runs, usual_fields(runs)[0])
    frames = list(zip(runs, indices))
    norm, extend = scale(field, frames, None)
    points = [run.columns(index)["position"] for run, index in frames]
    views = [view_of(run, points, None) for run in runs]
    in_space = plane_of(runs[-1], None) is None
    sheet = Sheet([views], Margins(left=0.15 if in_space else 0.5, bottom=0.12 if in_space else 0.42))
    names = labels(runs)
    for k, ((run, index), view) in enumerate(zip(frames, views)):
        time = float(run.times[index])
        draw_panel(sheet.panels[0][k], Look(field, norm), run, index, time, view)
        sheet.name_panel(0, k, f"{names[k]}, t = {time:.4g} s")
    sheet.add_colour_bar(field, norm, extend)
    sheet.settle()
    return sheet.figure


def _histories(comparison: Comparison) -> Figure:
    """Two panels per column, and one of the misplaced area."""
    count = len(comparison.columns) + (comparison.liquid is not None)
    across = min(ACROSS, count)
    down = -(-count // across)
    figure = empty_page(comparison.runs, WIDTH, HIGH * down + 0.2)
    axes = figure.subplots(2 * down, across, squeeze=False, sharex=True,
                           gridspec_kw={"height_ratios": [3, 2] * down})
    for k in range(across * down):
        over, below = axes[2 * (k // across)][k % across], axes[2 * (k // across) + 1][k % across]
        if k < len(comparison.columns):
            _draw_column(over, below, comparison, comparison.columns[k], WIDTH / across - BESIDE_TITLE)
        else:
            over.set_axis_off() if k >= count else _draw_liquid(over, comparison)
            below.set_axis_off()
    return figure


def _draw_column(over, below, comparison: Comparison, column: str, width: float) -> None:
    for k, run in enumerate(comparison.runs):
        over.plot(*samples(run, column, comparison.end), linewidth=0.8, color=COLOURS[k])
        if run is not comparison.last:
            below.plot(*difference_over_time(run, comparison.last, column, comparison.end), linewidth=0.8,
                       color=COLOURS[k])
    unit = comparison.last.units.get(column, "")
    title = column.replace("_", " ") + (f" [{unit}]" if unit not in ("", "1") else "")
    over.set_title(wrapped(title, width, 9.5), fontsize=9.5, loc="left")
    below.set_title("difference", fontsize=8, loc="right", pad=2)
    below.tick_params(labelbottom=True)
    below.axhline(0, color="0.6", linewidth=0.6, zorder=0)
    below.set_xlabel("$t$ [s]", fontsize=9)
    for axes in (over, below):
        quiet(axes)
        linear(axes)


def _draw_liquid(axes, comparison: Comparison) -> None:
    for k, shares in enumerate(comparison.liquid.shares.T):
        axes.plot(comparison.liquid.times, shares, ".-", linewidth=0.8, markersize=3, color=COLOURS[k])
    axes.set_title("misplaced area S", fontsize=9.5, loc="left")
    axes.set_xlabel("$t$ [s]", fontsize=9)
    axes.tick_params(labelbottom=True)
    quiet(axes)
    linear(axes)
