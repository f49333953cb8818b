"""One panel of a picture: particles and bodies of a run at a time, the walls, what they are compared with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.colors import Normalize

from figuring.fields import Field
from figuring.labels import width_of
from figuring.solids import draw_flat_bodies, draw_solid_bodies, has_bodies, hidden_by_bodies
from figuring.views import AXES, Slice, View, place, plane_of
from reporting.projection import project
from reporting.references import Curves, corners_at
from reporting.runs import Run
from reporting.surfaces import has_surface, surface_of

WALL = "#303030"
SURFACE = "#202020"
REFERENCE_COLOURS = ("#d62728", "#ff7f00", "#6a3d9a")
SAME_TIME = 1e-6  # [s]; times of references are written with few digits


@dataclass(frozen=True)
class Look:
    """How the panels of a picture show particles."""

    field: Field
    norm: Normalize
    cut: Slice | None = None
    references: Sequence[Curves] = ()
    corners: bool = False


def draw_panel(panel, look: Look, run: Run, index: int | None, time: float, view: View) -> None:
    """Frame `index` of a run; without one, when the run ended."""
    panel.set_xlim(view.low[0], view.high[0])
    panel.set_ylim(view.low[1], view.high[1])
    _draw_axes(panel, run, look.cut, view)
    _draw_box(panel, run, look.cut)
    if index is None:
        absent = panel.text(0.5, 0.5, "", transform=panel.transAxes, ha="center", va="center", color="0.4", fontsize=8)
        absent.whole = _absence(run, time)  # the sheet breaks it into lines
        return
    _draw_frame(panel, look, run, index)
    if run.dimension == 2 and has_surface(run, index):
        surface = surface_of(run, index)
        panel.add_collection(LineCollection(surface.points[surface.elements], colors=SURFACE, linewidths=0.8,
                                            capstyle="round", zorder=3))
    _draw_references(panel, look.references, time)
    if look.corners:
        _draw_corners(panel, run, time)


def _draw_frame(panel, look: Look, run: Run, index: int) -> None:
    """Particles and bodies; in 3-D those particles first that are behind a body."""
    columns = run.columns(index)
    places, which = place(run, columns["position"], look.cut)
    values = look.field.values(columns)[which]
    behind = np.ones(len(which), bool)
    if plane_of(run, look.cut) is not None:
        draw_flat_bodies(panel, run, index, look.cut)
    elif has_bodies(run):
        behind = hidden_by_bodies(run, index, places, project(run, columns["position"][which])[1])
        draw_solid_bodies(panel, run, index)
    for chosen, zorder in ((behind, 1), (~behind, 2)):
        if chosen.any():
            _draw_particles(panel, places[chosen], _diameter(panel, run), values[chosen], cmap=look.field.colour_map,
                            norm=look.norm, zorder=zorder)


def _absence(run: Run, time: float) -> str:
    if time < run.times[-1]:
        return "no frame at that time"
    ended = run.summary.get("time", float(run.times[-1]))
    return f"{'ended' if run.status == 'done' else run.status} at {ended:.3g} s"


def _draw_axes(panel, run: Run, cut: Slice | None, view: View) -> None:
    """Coordinates at the left and below; walls stand for the frame where they are in sight."""
    plane = plane_of(run, cut)
    if plane is None:
        panel.set_axis_off()
        return
    panel.set_xlabel(f"${AXES[plane[0]]}$ [m]", fontsize=9, labelpad=2)
    panel.set_ylabel(f"${AXES[plane[1]]}$ [m]", fontsize=9, labelpad=2)
    panel.tick_params(labelsize=8, length=2.5, width=0.6)
    panel.locator_params(nbins=4)
    for spine in panel.spines.values():
        spine.set(color="0.75", linewidth=0.6, visible=not view.whole)


def _diameter(panel, run: Run) -> float:
    """So that particles at rest just cover the plane; fine ones wide enough to be seen. [m]"""
    inches = panel.get_position().width * panel.figure.get_figwidth()
    finest = 0.6 / 72 * np.ptp(panel.get_xlim()) / inches
    return max(1.1 * run.particle_size, finest)


def _draw_particles(panel, places: np.ndarray, diameter: float, values: np.ndarray, **colours) -> None:
    sizes = np.full(len(values), diameter)
    panel.add_collection(EllipseCollection(sizes, sizes, np.zeros(len(values)), units="xy", offsets=places,
                                           linewidths=0, offset_transform=panel.transData,
                                           array=np.ma.masked_invalid(values), **colours))


def _draw_box(panel, run: Run, cut: Slice | None) -> None:
    """The walls; in 3-D the edges of the box, those behind the liquid lighter."""
    low, high = run.box
    plane = plane_of(run, cut)
    if plane is None:
        _draw_edges(panel, run)
        return
    sides = list(plane)
    corners = np.array(list(product(*zip(low[sides], high[sides]))))
    pairs = _edges(corners)
    styles = [_wall_style(run, sides[int(np.argmax(corners[a] == corners[b]))]) for a, b in pairs]
    panel.add_collection(LineCollection([corners[[a, b]] for a, b in pairs], colors=WALL, linewidths=1.2,
                                        linestyles=styles, capstyle="projecting", zorder=3))


def _edges(corners: np.ndarray) -> list[tuple[int, int]]:
    """Pairs of corners of a box that differ in one coordinate."""
    return [(a, b) for a, b in product(range(len(corners)), repeat=2)
            if a < b and np.count_nonzero(corners[a] != corners[b]) == 1]


def _draw_edges(panel, run: Run) -> None:
    low, high = run.box
    corners = np.array(list(product(*zip(low, high))))
    pairs = _edges(corners)
    places, distance = project(run, corners)
    farthest, nearest = int(np.argmax(distance)), int(np.argmin(distance))
    behind = [places[[a, b]] for a, b in pairs if farthest in (a, b)]
    outline = [(a, b) for a, b in pairs if farthest not in (a, b) and nearest not in (a, b)]
    before = [places[[a, b]] for a, b in pairs if nearest in (a, b)]
    panel.add_collection(LineCollection(behind, colors="0.75", linewidths=0.7, zorder=0))
    panel.add_collection(LineCollection([places[list(pair)] for pair in outline], colors=WALL, linewidths=0.9,
                                        capstyle="round", zorder=0))
    panel.add_collection(LineCollection(before, colors=WALL, linewidths=0.6, alpha=0.6, zorder=3))
    _name_edges(panel, corners, places, outline)


def _name_edges(panel, corners: np.ndarray, places: np.ndarray, outline: list[tuple[int, int]]) -> None:
    """Axis and length next to an edge of the outline for each axis: the lowest ones, of the upright ones the left."""
    middle = places.mean(axis=0)
    for axis in range(3):
        along = [pair for pair in outline if corners[pair[0]][axis] != corners[pair[1]][axis]]
        a, b = min(along, key=lambda pair: tuple(places[list(pair)].mean(axis=0)[::-1].round(9)))
        ends = places[[a, b]]
        direction = ends[1] - ends[0]
        angle = np.degrees(np.arctan2(direction[1], direction[0]))
        angle = (angle + 89) % 180 - 89  # to be read from below, or from the right
        outward = np.array([-direction[1], direction[0]]) / np.linalg.norm(direction)
        outward *= np.sign(outward @ (ends.mean(axis=0) - middle))
        length = f"{np.linalg.norm(corners[a] - corners[b]):.4g} m"
        inches = panel.get_position().width * panel.figure.get_figwidth() / np.ptp(panel.get_xlim())
        longer = width_of(f"x: {length}", 7) - np.linalg.norm(direction) * inches  # than the edge: it stands farther off
        panel.annotate(f"${AXES[axis]}$: {length}", ends.mean(axis=0), (8 + 72 * max(0.0, longer)) * outward,
                       textcoords="offset points", rotation=angle, rotation_mode="anchor", ha="center", va="center",
                       fontsize=7, annotation_clip=False)


def _wall_style(run: Run, axis: int) -> str:
    """Sides that are no walls are dotted."""
    walls = run.scene.get("walls", "slip")
    walls = walls.get(AXES[axis], "slip") if isinstance(walls, dict) else walls
    return "dotted" if walls == "periodic" else "solid"


def reference_colours(references: Sequence[Curves], times: list[float]) -> dict[str, str]:
    """Colour of every reference that has a line at one of the times."""
    names = [curves.name for curves in references if min(abs(curves.time - np.array(times))) < SAME_TIME]
    return dict(zip(dict.fromkeys(names), REFERENCE_COLOURS))


def _draw_references(panel, references: Sequence[Curves], time: float) -> None:
    for name, colour in reference_colours(references, [time]).items():
        segments = [line for curves in references if curves.name == name and abs(curves.time - time) < SAME_TIME
                    for line in curves.segments]
        panel.add_collection(LineCollection(segments, colors=colour, linewidths=0.9, zorder=4))


def _draw_corners(panel, run: Run, time: float) -> None:
    """The way of every corner since the start, and where it must have got to."""
    ways = np.stack([corners_at(run, 0), corners_at(run, time)], axis=1)
    panel.add_collection(LineCollection(ways, colors=REFERENCE_COLOURS[0], linewidths=0.7, zorder=4))
    panel.plot(*ways[:, 1].T, "x", color=REFERENCE_COLOURS[0], markersize=5, markeredgewidth=1.2, clip_on=False)
