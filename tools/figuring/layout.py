"""Panels in rows, a colour bar beside them, names around them; margins in inches."""

from __future__ import annotations

import io
from dataclasses import dataclass

from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, NullLocator

from figuring.fields import Field
from figuring.views import View

WIDTH = 7.2  # of a page with two columns [inch]
LARGEST_PANEL = (3.6, 6.0)  # [inch]


@dataclass(frozen=True)
class Margins:
    """Room around the panels and between them. [inch]"""

    left: float
    bottom: float
    right: float = 0.85
    top: float = 0.28
    across: float = 0.2
    down: float = 0.1


def lay_out(rows: list[list[View]], margins: Margins, width: float = WIDTH) -> tuple[Figure, list[list]]:
    """Panels of equal width with the aspect of what they show. The figure gets `bar_place`, room for a colour bar."""
    columns = max(len(row) for row in rows)
    tallest = max(view.aspect for row in rows for view in row)
    inside = (width - margins.left - margins.right - margins.across * (columns - 1)) / columns
    panel = min(inside, LARGEST_PANEL[0], LARGEST_PANEL[1] / tallest)
    width = margins.left + margins.right + columns * panel + margins.across * (columns - 1)
    heights = [panel * max(view.aspect for view in row) for row in rows]
    height = margins.top + margins.bottom + sum(heights) + margins.down * (len(rows) - 1)
    figure = Figure(figsize=(width, height))
    panels, y = [], height - margins.top
    for row, tall in zip(rows, heights):
        y -= tall
        panels.append([figure.add_axes([(margins.left + k * (panel + margins.across)) / width, y / height,
                                        panel / width, panel * view.aspect / height])
                       for k, view in enumerate(row)])
        y -= margins.down
    figure.bar_place = [1 - (margins.right - 0.12) / width, margins.bottom / height, 0.12 / width,
                        1 - (margins.top + margins.bottom) / height]
    return figure, panels


def label_outer(panels: list[list]) -> None:
    """Coordinates at the left of the first column and below the panels that have none below them."""
    for i, row in enumerate(panels):
        for k, panel in enumerate(row):
            if k > 0:
                panel.set_ylabel("")
                panel.tick_params(labelleft=False)
            if any(len(lower) > k for lower in panels[i + 1:]):
                panel.set_xlabel("")
                panel.tick_params(labelbottom=False)


def colour_bar(figure: Figure, shown: Field, norm: Normalize, extend: str) -> None:
    """Beside the panels, not longer than 3 inches."""
    x, y, width, height = figure.bar_place
    used = min(height, 3.0 / figure.get_figheight())
    axes = figure.add_axes([x, y + 0.5 * (height - used), width, used])
    bar = figure.colorbar(ScalarMappable(norm, shown.colour_map), cax=axes, extend=extend, extendfrac=0.03)
    if shown.classes:
        bar.set_ticks(range(len(shown.classes)), labels=shown.classes)
        bar.ax.yaxis.set_minor_locator(NullLocator())
    else:
        bar.set_label(shown.label, fontsize=9)
        bar.ax.yaxis.set_major_locator(MaxNLocator(6))
    bar.ax.tick_params(labelsize=8, length=2.5, width=0.6)
    bar.outline.set_linewidth(0.5)


def png(figure: Figure, dots_per_inch: int = 200) -> bytes:
    """A figure as a PNG file."""
    file = io.BytesIO()
    figure.savefig(file, dpi=dots_per_inch, facecolor="white", pil_kwargs={"optimize": True})
    return file.getvalue()
