"""Picture strips: the particles of one or several runs at some times, a row per run."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from reporting.references import Curves, corners_at
from reporting.runs import Frame, NoResults, Run, labels
from reporting.views import View, project, view_of

WALL = "#303030"
REFERENCE_COLOURS = ("#e31a1c", "#ff7f00", "#6a3d9a")


@dataclass(frozen=True)
class Field:
    """What the particles are coloured by."""

    name: str
    unit: str
    colours: str  # perceptually uniform, and different for every field

    def values(self, frame: Frame) -> np.ndarray:
        return getattr(frame, self.name)


FIELDS = {"speed": Field("speed", "m/s", "viridis"), "pressure": Field("pressure", "Pa", "cividis")}


@dataclass(frozen=True)
class Strip:
    """What a picture strip shows."""

    runs: list[Run]
    times: list[float]  # [s]
    field: Field
    references: Sequence[Curves] = ()
    corners: bool = False
    width: float = 10.0  # [inch]


def draw_strip(strip: Strip) -> Figure:
    """A row per run, a column per time, one colour scale."""
    frames = [[run.frame_at(time, _tolerance(run)) for time in strip.times] for run in strip.runs]
    if not any(frame for row in frames for frame in row):
        raise NoResults(f"{', '.join(str(run.folder) for run in strip.runs)}: no frame at t = "
                        f"{', '.join(f'{time:g}' for time in strip.times)} s")
    norm, extend = _scale(strip.field, [frame for row in frames for frame in row if frame])
    views = [view_of(run, _in_the_box_of(run, strip, frames)) for run in strip.runs]
    figure, panels = _layout(strip, views)
    for axes, run, row, view in zip(panels, strip.runs, frames, views):
        for panel, time, frame in zip(axes, strip.times, row):
            _draw_panel(panel, strip, run, time, frame, view, norm)
    _name_rows_and_columns(strip, panels)
    _colour_bar(figure, strip.field, norm, extend)
    _legend(figure, strip)
    return figure


def _in_the_box_of(run: Run, strip: Strip, frames: list[list[Frame | None]]) -> list[np.ndarray]:
    """All points to be shown of runs with the same box, so that their pictures have the same view. [m]"""
    points = [frame.position for other, row in zip(strip.runs, frames) if np.array_equal(other.box, run.box)
              for frame in row if frame]
    return points + [corners_at(run, time) for time in strip.times] if strip.corners else points


def _tolerance(run: Run) -> float:
    """Within which a frame is said to be at a time: output times are hit to a time step."""
    return 2e-3 * float(run.times[-1]) if len(run.times) else 0.0


def _scale(shown: Field, frames: list[Frame]) -> tuple[Normalize, str]:
    """From 0 on; the few particles beyond are left to the arrows of the colour bar."""
    values = np.concatenate([shown.values(frame) for frame in frames])
    low, high = np.percentile(values, [0.5, 99.5])
    low = 0.0 if low > -0.05 * abs(high) else low
    ticks = MaxNLocator(6).tick_values(low, high if high > low else low + 1)
    low = 0.0 if low == 0 else ticks[0]
    beyond = (values.min() < low - 0.02 * (ticks[-1] - low), values.max() > ticks[-1])
    extend = {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}[beyond]
    return Normalize(low, ticks[-1]), extend


def _layout(strip: Strip, views: list[View]) -> tuple[Figure, list[list]]:
    """Panels with the aspect of their box; all margins in inches."""
    left, right, top, gap = (0.45 if len(strip.runs) > 1 else 0.1), 0.95, 0.32, 0.1
    bottom = 0.38 if strip.references or strip.corners else 0.08
    count = len(strip.times)
    panel = min((strip.width - left - right - gap * (count - 1)) / count, 4.0)
    width = left + right + count * panel + gap * (count - 1)
    heights = [panel * view.aspect for view in views]
    height = top + bottom + sum(heights) + gap * (len(heights) - 1)
    figure = Figure(figsize=(width, height))
    rows, y = [], height - top
    for each in heights:
        y -= each
        rows.append([figure.add_axes([(left + k * (panel + gap)) / width, y / height, panel / width, each / height])
                     for k in range(count)])
        y -= gap
    figure.bar_place = [1 - (right - 0.12) / width, bottom / height, 0.14 / width, 1 - (top + bottom) / height]
    return figure, rows


def _draw_panel(panel, strip: Strip, run: Run, time: float, frame: Frame | None, view: View, norm: Normalize) -> None:
    panel.set_xlim(view.low[0], view.high[0])
    panel.set_ylim(view.low[1], view.high[1])
    panel.set_axis_off()
    if frame is None:
        panel.text(0.5, 0.5, "no output", transform=panel.transAxes, ha="center", va="center", color="0.5")
        return
    _draw_box(panel, run)
    place, order = frame.position, slice(None)
    if run.dimension == 3:
        place, distance = project(run, frame.position)
        order = np.argsort(-distance)
    _draw_particles(panel, place[order], _diameter(panel, run), strip.field.values(frame)[order],
                    cmap=strip.field.colours, norm=norm)
    _draw_references(panel, strip, time)
    if strip.corners:
        panel.plot(*corners_at(run, frame.time).T, "x", color=REFERENCE_COLOURS[0], markersize=6, markeredgewidth=1.3)


def _diameter(panel, run: Run) -> float:
    """So that particles at rest just cover the plane; fine ones wide enough to be seen. [m]"""
    inches = panel.get_position().width * panel.figure.get_figwidth()
    finest = 0.8 / 72 * np.ptp(panel.get_xlim()) / inches
    return max(1.1 * run.particle_size, finest)


def _draw_particles(panel, place: np.ndarray, diameter: float, values: np.ndarray, **colours) -> None:
    sizes = np.full(len(values), diameter)
    panel.add_collection(EllipseCollection(sizes, sizes, np.zeros(len(values)), units="xy", offsets=place, linewidths=0,
                                           offset_transform=panel.transData, array=values, **colours))


def _draw_box(panel, run: Run) -> None:
    """The walls; in space the edges of the box, those behind the liquid lighter."""
    low, high = run.box
    corners = np.array(list(product(*zip(low, high))))
    pairs = [(a, b) for a, b in product(range(len(corners)), repeat=2)
             if a < b and np.count_nonzero(corners[a] != corners[b]) == 1]
    if run.dimension == 2:
        panel.add_collection(LineCollection([corners[[a, b]] for a, b in pairs], colors=WALL, linewidths=1.4,
                                            linestyles=[_wall_style(run, *corners[[a, b]]) for a, b in pairs],
                                            capstyle="projecting", zorder=3))
        return
    place, distance = project(run, corners)
    farthest, nearest = int(np.argmax(distance)), int(np.argmin(distance))
    behind = [place[[a, b]] for a, b in pairs if farthest in (a, b)]
    outline = [place[[a, b]] for a, b in pairs if farthest not in (a, b) and nearest not in (a, b)]
    before = [place[[a, b]] for a, b in pairs if nearest in (a, b)]
    panel.add_collection(LineCollection(behind, colors="0.75", linewidths=0.7, zorder=0))
    panel.add_collection(LineCollection(outline, colors=WALL, linewidths=0.9, capstyle="round", zorder=0))
    panel.add_collection(LineCollection(before, colors=WALL, linewidths=0.6, alpha=0.6, zorder=3))


def _wall_style(run: Run, start: np.ndarray, end: np.ndarray) -> str:
    """Sides that are no walls are dotted."""
    axis = int(np.argmax(start == end))
    walls = run.scene.get("walls", "slip")
    walls = walls.get("xyz"[axis], "slip") if isinstance(walls, dict) else walls
    return "dotted" if walls == "periodic" else "solid"


def _draw_references(panel, strip: Strip, time: float) -> None:
    for name, colour in _reference_colours(strip).items():
        segments = [line for curves in strip.references if curves.name == name and abs(curves.time - time) < 1e-6
                    for line in curves.segments]
        panel.add_collection(LineCollection(segments, colors=colour, linewidths=1.0, zorder=4))


def _reference_colours(strip: Strip) -> dict[str, str]:
    """Colour of every reference that has a line at one of the times."""
    names = [curves.name for curves in strip.references if min(abs(curves.time - np.array(strip.times))) < 1e-6]
    return dict(zip(dict.fromkeys(names), REFERENCE_COLOURS))


def _name_rows_and_columns(strip: Strip, panels: list[list]) -> None:
    decimals = max(len(f"{time:.4g}".partition(".")[2]) for time in strip.times)
    for panel, time in zip(panels[0], strip.times):
        panel.set_title(f"$t$ = {time:.{decimals}f} s", fontsize=10, pad=5)
    if len(panels) == 1:
        return
    for row, label in zip(panels, labels(strip.runs)):
        row[0].annotate(label, (0, 0.5), (-14, 0), xycoords="axes fraction", textcoords="offset points", rotation=90,
                        ha="center", va="center", fontsize=11, fontweight="bold")


def _colour_bar(figure: Figure, shown: Field, norm: Normalize, extend: str) -> None:
    x, y, width, height = figure.bar_place
    used = min(height, 4.0 / figure.get_figheight())
    axes = figure.add_axes([x, y + 0.5 * (height - used), width, used])
    bar = figure.colorbar(ScalarMappable(norm, shown.colours), cax=axes, extend=extend, extendfrac=0.03)
    bar.set_label(f"{shown.name} [{shown.unit}]", fontsize=10)
    bar.ax.yaxis.set_major_locator(MaxNLocator(6))
    bar.ax.tick_params(labelsize=9, length=2.5)
    bar.outline.set_linewidth(0.5)


def png(figure: Figure, dots_per_inch: int = 120) -> bytes:
    """A figure as a PNG file."""
    file = io.BytesIO()
    figure.savefig(file, dpi=dots_per_inch, facecolor="white", pil_kwargs={"optimize": True})
    return file.getvalue()


def _legend(figure: Figure, strip: Strip) -> None:
    lines = [Line2D([], [], color=colour, linewidth=1.2, label=name)
             for name, colour in _reference_colours(strip).items()]
    if strip.corners:
        lines.append(Line2D([], [], color=REFERENCE_COLOURS[0], marker="x", linestyle="none", label="corners, exact"))
    if lines:
        figure.legend(handles=lines, loc="lower center", ncol=len(lines), frameon=False, fontsize=9.5,
                      bbox_to_anchor=(0.5, 0.0))
