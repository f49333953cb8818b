"""Words in pictures: how wide they are, lines of them that fit into their place, where they are drawn."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.legend import Legend
from matplotlib.text import Text
from matplotlib.textpath import text_to_path
from matplotlib.transforms import Bbox

POINTS = 72  # per inch
LEFT_OUT = "…"
BESIDE_HANDLE = 0.6  # of a line of a legend: its handle, and the room around it [inch]


def width_of(text: str, size: float, weight: str = "normal") -> float:
    """Of a line as it stands. [inch]"""
    font = FontProperties(size=size, weight=weight)
    return text_to_path.get_text_width_height_descent(text, font, False)[0] / POINTS


def wrapped(text: str, width: float, size: float, lines: int = 3, weight: str = "normal") -> str:
    """A name in lines that are no wider than that [inch]; of one that takes too many the middle is left out, because
    names that are alike differ at their ends. No character of it is part of a formula."""
    found = _lines(text, width, size, weight)
    kept = len(text)
    while len(found) > lines and kept > 2:
        kept -= 1
        found = _lines(text[:-(-kept // 2)].rstrip() + LEFT_OUT + text[len(text) - kept // 2:].lstrip(), width, size,
                       weight)
    return "\n".join(found).replace("$", r"\$")


def _lines(text: str, width: float, size: float, weight: str) -> list[str]:
    """Broken between words and after strokes, a long word anywhere."""
    lines = [""]
    for word in re.findall(r"\s*[^\s_/-]*[_/-]*", text):
        if width_of((lines[-1] + word).strip(), size, weight) <= width:
            lines[-1] += word
            continue
        lines.append("")
        for letter in word.lstrip():
            if lines[-1] and width_of(lines[-1] + letter, size, weight) > width:
                lines.append("")
            lines[-1] += letter
    return [line.strip() for line in lines if line.strip()]


def fitting_legend(figure: Figure, handles: Sequence[Artist], names: Sequence[str], size: float, **place) -> Legend:
    """A legend of the page in as many columns as have room across it."""
    width = figure.get_figwidth()
    names = [wrapped(name, width - BESIDE_HANDLE, size, 2) for name in names]
    for columns in range(len(names), 0, -1):
        legend = figure.legend(handles, names, ncol=columns, fontsize=size, frameon=False, **place)
        if columns == 1 or box_of(legend).width <= width:
            return legend
        legend.remove()
    raise ValueError("a legend of nothing")


def words_of(axes: Axes) -> list[Text]:
    """What is written in an axes and around it."""
    found = [*axes.texts, axes.title]
    if axes.axison:
        for axis in (axes.xaxis, axes.yaxis):
            found += [axis.label, axis.offsetText, *tick_labels(axis)]
    return [text for text in found if text.get_visible() and text.get_text().strip()]


def tick_labels(axis) -> Iterator[Text]:
    """Those that are drawn: ticks beyond the ends are not."""
    low, high = sorted(axis.get_view_interval())
    slack = 1e-9 * (high - low)
    return (label for tick in axis.get_major_ticks() if low - slack <= tick.get_loc() <= high + slack
            for label in (tick.label1, tick.label2) if label.get_visible())


def box_of(drawn: Artist) -> Bbox:
    """Where it was when the figure was drawn, with rendering or without. [inch]"""
    return Bbox(drawn.get_window_extent(drawn.figure.canvas.get_renderer()).get_points() / drawn.figure.dpi)
