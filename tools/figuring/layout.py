"""Panels in rows, a colour bar next to them, names around them, of which none is cut off or printed over another."""

from __future__ import annotations

import io
from dataclasses import dataclass, replace
from itertools import chain, pairwise

from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.ticker import MaxNLocator, NullLocator
from matplotlib.transforms import Bbox, ScaledTranslation

from figuring.fields import Field
from figuring.labels import LEFT_OUT, box_of, fitting_legend, tick_labels, words_of, wrapped
from figuring.views import View

WIDTH = 7.2  # of a page with two columns [inch]
LARGEST_PANEL = (3.6, 6.0)  # [inch]
SMALLEST_PANEL = 0.3  # across; rather the page becomes wider [inch]
TALL = 1.2  # panels of a row that have the name of the row next to them, however long it is [inch]
GAP = 0.04  # between words, and to the edge of the page [inch]
PASSES = 8  # of measuring; two or three do for most pictures


@dataclass(frozen=True)
class Margins:
    """Room around the panels and between them; it grows with what is written there. [inch]"""

    left: float
    bottom: float
    right: float = 0.85
    top: float = 0.28
    across: float = 0.2
    beside: float = 0.12  # of the right, before the colour bar
    down: float = 0.1


class Sheet:
    """Panels of equal width with the aspect of what they show. Draw into them, name them, then settle()."""

    def __init__(self, rows: list[list[View]], margins: Margins, largest: tuple[float, float] = LARGEST_PANEL):
        self.figure = Figure()
        FigureCanvasAgg(self.figure)
        self.panels = [[self.figure.add_axes((0, 0, 1, 1)) for _ in row] for row in rows]
        self.head = self.figure.text(0.5, 1, "", fontsize=10, ha="center", va="center")
        self._rows, self._margins, self._largest = rows, margins, largest
        self._names: dict[tuple[int, int], str] = {}  # of panels
        self._row_names: list[tuple[str, Text]] = []
        self._entries: list[Artist] = []  # of the legend
        self._legend = self._bar = None
        self._bar_label = ""
        self._bins = {"x": 4, "y": 4, "bar": 6}  # between ticks
        self._place()

    def name_panel(self, row: int, column: int, name: str) -> None:
        """Above the panel."""
        self._names[row, column] = name

    def name_rows(self, names: list[str]) -> None:
        """To the left of the rows, above those that are too low for it."""
        self._row_names = [(name, row[0].text(0, 0, "", fontweight="bold")) for name, row in zip(names, self.panels)]

    def add_legend(self, entries: list[Artist]) -> None:
        """At the foot."""
        self._entries = entries

    def add_colour_bar(self, shown: Field, norm: Normalize, extend: str) -> None:
        """Next to the panels, not longer than 3 inches."""
        self._bar = self.figure.add_axes((0, 0, 1, 1))
        bar = self.figure.colorbar(ScalarMappable(norm, shown.colour_map), cax=self._bar, extend=extend, extendfrac=0.03)
        if shown.classes:
            bar.set_ticks(range(len(shown.classes)), labels=[wrapped(name, 1.2, 8) for name in shown.classes])
            self._bar.yaxis.set_minor_locator(NullLocator())
        else:
            self._bar_label = shown.label
            self._bar.yaxis.set_major_locator(MaxNLocator(self._bins["bar"]))
        self._bar.tick_params(labelsize=8, length=2.5, width=0.6)
        bar.outline.set_linewidth(0.5)
        self._place()

    def dress(self) -> None:
        """What drawing into the panels takes away: their names, and that coordinates stand at the left of the first
        column and below the panels that have none below them."""
        for i, row in enumerate(self.panels):
            for k, panel in enumerate(row):
                if (i, k) in self._names:
                    name = wrapped(self._names[i, k], self._panel + self._margins.across - GAP, 9)
                    panel.set_title(name, fontsize=9, pad=4)
                if k > 0:
                    panel.set_ylabel("")
                    panel.tick_params(labelleft=False)
                    panel.yaxis.offsetText.set_visible(False)
                if any(len(lower) > k for lower in self.panels[i + 1:]):
                    panel.set_xlabel("")
                    panel.tick_params(labelbottom=False)
                    panel.xaxis.offsetText.set_visible(False)
                for axis in "xy" if panel.axison else "":
                    panel.locator_params(axis, nbins=self._bins[axis], min_n_ticks=1)

    def settle(self) -> None:
        """Measures the words, and makes room for them."""
        self.figure.draw_without_rendering()
        for _ in range(PASSES):
            self.dress()
            self._fit_names()
            self.figure.draw_without_rendering()
            grown, is_thinned = self._grown(), self._thin_ticks()
            if grown == self._margins and not is_thinned:
                break
            self._margins = grown
            self._place()
            self.figure.draw_without_rendering()

    def _place(self) -> None:
        """Puts everything where the margins leave room for it."""
        margins, columns = self._margins, max(map(len, self._rows))
        tallest = max(view.aspect for row in self._rows for view in row)
        inside = (WIDTH - margins.left - margins.right - margins.across * (columns - 1)) / columns
        self._panel = max(SMALLEST_PANEL, min(inside, self._largest[0], self._largest[1] / tallest))
        self._heights = [self._panel * max(view.aspect for view in row) for row in self._rows]
        width = margins.left + margins.right + columns * self._panel + margins.across * (columns - 1)
        inner = sum(self._heights) + margins.down * (len(self._rows) - 1)
        height = margins.top + margins.bottom + inner
        self.figure.set_size_inches(width, height)
        y = height - margins.top
        for row, panels, tall in zip(self._rows, self.panels, self._heights):
            y -= tall
            for k, (view, panel) in enumerate(zip(row, panels)):
                x = margins.left + k * (self._panel + margins.across)
                panel.set_position((x / width, y / height, self._panel / width, self._panel * view.aspect / height))
            y -= margins.down
        self.head.set_position((0.5, 1 - 0.16 / height))
        if self._bar:
            used = min(inner, 3.0)
            self._bar.set_position((1 - (margins.right - margins.beside) / width,
                                    (margins.bottom + 0.5 * (inner - used)) / height, 0.12 / width, used / height))

    def _fit_names(self) -> None:
        for (name, text), row, height in zip(self._row_names, self.panels, self._heights):
            self._name_row(name, text, row, height)
        for text in chain(*(panel.texts for panel in chain(*self.panels))):
            if hasattr(text, "whole"):
                text.set_text(wrapped(text.whole, self._panel - GAP, text.get_fontsize(), 6))
        if self._bar_label:
            self._bar.set_ylabel(wrapped(self._bar_label, self.figure.get_figheight() - 2 * GAP, 9), fontsize=9)
        if self._entries:
            if self._legend:
                self._legend.remove()
            self._legend = fitting_legend(self.figure, self._entries, [entry.get_label() for entry in self._entries], 8.5,
                                          loc="lower center", bbox_to_anchor=(0.5, 0.0), borderaxespad=0.2)

    def _name_row(self, name: str, text: Text, row: list, height: float) -> None:
        """Next to what is written around the first panel, or around all of a low row."""
        beside = wrapped(name, height, 10, 2, "bold")
        if LEFT_OUT not in beside or height >= TALL:
            words = [box_of(word) for word in words_of(row[0]) if word is not text]
            reach = min([0.0, *(box.x0 - box_in_page(row[0]).x0 for box in words)])
            if LEFT_OUT in beside:
                beside, size = wrapped(name, height, 8, 4, "bold"), 8
            else:
                size = 10
            how = {"rotation": 90, "ha": "right", "va": "center", "multialignment": "center"}
            place, shift, lines = (0, 0.5), (reach - GAP, 0), beside
        else:
            words = [box_of(word) for word in chain(*map(words_of, row)) if word is not text]
            reach = max([0.0, *(box.y1 - box_in_page(row[0]).y1 for box in words)])
            size = 10
            how = {"rotation": 0, "ha": "left", "va": "bottom", "multialignment": "left"}
            width = len(row) * (self._panel + self._margins.across)
            place, shift, lines = (0, 1), (0, reach + GAP), wrapped(name, width, size, 2, "bold")
        text.set(text=lines, fontsize=size, position=place, **how,
                 transform=row[0].transAxes + ScaledTranslation(*shift, self.figure.dpi_scale_trans))

    def _grown(self) -> Margins:
        """With room for what is cut off or lies over something else."""
        width, height = self.figure.get_size_inches()
        panels = [[[box_of(word) for word in words_of(panel)] for panel in row] for row in self.panels]
        frames = [[box_in_page(panel) for panel in row] for row in self.panels]
        foot = [box_of(self._legend)] if self._legend else []
        head = [box_of(self.head)] if self.head.get_text() else []
        bar = [box_of(word) for word in words_of(self._bar)] if self._bar else []
        ends = chain(*(row[-1] for row in panels))
        beside = _too_near(ends, [box_in_page(self._bar)], across=True) if self._bar else 0.0
        words = [*chain(*chain(*panels)), *bar, *foot, *head]
        more = {"left": GAP - min(box.x0 for box in words),
                "right": max(max(box.x1 for box in words) + GAP - width, beside), "beside": beside,
                "bottom": max([GAP - min(box.y0 for box in words), _too_near(foot, chain(*panels[-1]))]),
                "top": max([max(box.y1 for box in words) + GAP - height, _too_near(chain(*panels[0]), head)]),
                "across": max([0.0, *(_too_near(a, b, across=True) for row in panels for a, b in pairwise(row))]),
                "down": max([0.0, *(max(_too_near(chain(*panels[i + 1]), [*chain(*panels[i]), *frames[i]]),
                                        _too_near(frames[i + 1], chain(*panels[i]))) for i in range(len(panels) - 1))])}
        enough = 1e-3  # [inch]
        return replace(self._margins, **{name: getattr(self._margins, name) + by for name, by in more.items()
                                         if by > enough})

    def _thin_ticks(self) -> bool:
        """Fewer ticks along an axis where their numbers meet. Whether there are fewer now."""
        before = dict(self._bins)
        axes = [(name, axis) for panel in chain(*self.panels) if panel.axison
                for name, axis in (("x", panel.xaxis), ("y", panel.yaxis))]
        for name, axis in [*axes, *([("bar", self._bar.yaxis)] if self._bar else [])]:
            boxes = [box_of(label) for label in tick_labels(axis)]
            if before[name] > 1 and any(_too_near([a], [b], across=name == "x") > 0 for a, b in pairwise(boxes)):
                self._bins[name] = before[name] - 1
        if self._bar_label:
            self._bar.yaxis.set_major_locator(MaxNLocator(self._bins["bar"], min_n_ticks=1))
        return self._bins != before


def box_in_page(panel) -> Bbox:
    """[inch]"""
    return Bbox(panel.get_position().get_points() * panel.figure.get_size_inches())


def _too_near(low, high, across: bool = False) -> float:
    """How much nearer than GAP boxes come to those above them, or to the right of them. [inch]"""
    low, high = list(low), list(high)
    if across:
        pairs = [(a.x1, b.x0) for a in low for b in high if a.y0 < b.y1 and b.y0 < a.y1]
    else:
        pairs = [(a.y1, b.y0) for a in low for b in high if a.x0 < b.x1 and b.x0 < a.x1]
    return max([0.0, *(a + GAP - b for a, b in pairs)])


def png(figure: Figure, dots_per_inch: int = 200) -> bytes:
    """A figure as a PNG file."""
    file = io.BytesIO()
    figure.savefig(file, dpi=dots_per_inch, facecolor="white", pil_kwargs={"optimize": True})
    return file.getvalue()
