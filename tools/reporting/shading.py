"""Still pictures of surfaces in 3-D, lit from the left above."""

from __future__ import annotations

import base64
from html import escape
from io import BytesIO
from itertools import product

import numpy as np

from reporting.bodies import bodies_of
from reporting.projection import project
from reporting.runs import Run
from reporting.surfaces import Surface, has_surface, surface_of

WATER, BODY, WALL = np.array([0.30, 0.55, 0.80]), np.array([0.75, 0.77, 0.80]), "#808080"
LIGHT = np.array([-0.5, 0.6, -0.63])  # to the right, up, away from the eye
FINEST = 240  # parts of the box, along its longest side, that are still told apart
INCHES, DOTS = 3.6, 110


def surface_section(run: Run, times: list[float]) -> str:
    """Pictures of the surface of a run in 3-D at output times, as a part of a page; empty if it has none. [s]"""
    frames = [int(np.abs(run.times - time).argmin()) for time in times] if run.dimension == 3 and len(run.times) else []
    frames = [frame for frame in dict.fromkeys(frames) if has_surface(run, frame)]
    if not frames:
        return ""
    head = f"<h2>Surface: {escape(run.title)}</h2>"
    try:
        pictures = [(run.times[frame], shaded(run, frame)) for frame in frames]
    except ModuleNotFoundError as missing:
        return f"{head}<p>Its pictures need the python module {escape(str(missing.name))}.</p>"
    figures = [f"<figure><img alt=\"Surface at {time:.4g} s\" src=\"data:image/png;base64,"
               f"{base64.b64encode(picture).decode()}\"><figcaption>{time:.4g} s</figcaption></figure>"
               for time, picture in pictures]
    return f"{head}<div class=\"surfaces\">{''.join(figures)}</div>"


def shaded(run: Run, frame: int) -> bytes:
    """The surface of a frame, bodies and the box, as a PNG. \throws ModuleNotFoundError without matplotlib"""
    from matplotlib.collections import LineCollection, PolyCollection  # slow to load, and not needed by most pages
    from matplotlib.figure import Figure

    low, high = run.box
    parts = [(coarsened(surface_of(run, frame), float((high - low).max()) / FINEST), WATER)]
    parts += [(Surface(body.points_at(frame), body.elements), BODY) for body in bodies_of(run)]
    flat = [_lit(run, surface, colour) for surface, colour in parts]
    places, depth, colours = (np.concatenate([each[k] for each in flat]) for k in range(3))
    order = np.argsort(-depth)
    corners = np.array(list(product(*zip(low, high))))
    seen, _ = project(run, corners)
    edges = [seen[[a, b]] for a, b in product(range(8), repeat=2)
             if a < b and np.count_nonzero(corners[a] != corners[b]) == 1]
    size = np.ptp(seen, axis=0)
    figure = Figure(figsize=(INCHES, INCHES * size[1] / size[0]))
    panel = figure.add_axes((0.01, 0.01, 0.98, 0.98))
    panel.set_axis_off()
    panel.add_collection(LineCollection(edges, colors=WALL, linewidths=0.6))
    panel.add_collection(PolyCollection(places[order], facecolors=colours[order], edgecolors=colours[order],
                                        linewidths=0.3))
    panel.set(xlim=(seen[:, 0].min(), seen[:, 0].max()), ylim=(seen[:, 1].min(), seen[:, 1].max()), aspect="equal")
    picture = BytesIO()
    figure.savefig(picture, dpi=DOTS, transparent=True)
    return picture.getvalue()


def coarsened(surface: Surface, cell: float) -> Surface:
    """One point for all in a cube, their mean (J. Rossignac, P. Borrel, 1993); what lies within one cube is gone.
    `cell`: the side of the cubes [m]."""
    if len(surface.points) == 0:
        return surface
    cubes = np.floor(surface.points / cell).astype(np.int64)
    cubes -= cubes.min(axis=0)
    widths = cubes.max(axis=0) + 1
    _, which = np.unique((cubes[:, 0] * widths[1] + cubes[:, 1]) * widths[2] + cubes[:, 2], return_inverse=True)
    count = np.bincount(which)
    points = np.stack([np.bincount(which, x) for x in surface.points.T], axis=1) / count[:, None]
    elements = which[surface.elements]
    a, b, c = elements.T
    return Surface(points, elements[(a != b) & (b != c) & (c != a)])


def _lit(run: Run, surface: Surface, colour: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of the triangles that face the eye: places of the corners, depths of the middles, colours."""
    places, depth = project(run, surface.points)
    seen = np.column_stack([places, depth])
    a, b, c = (seen[surface.elements[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    # Depth is away from the eye: right, up and away are a left-handed frame.
    facing = normal[:, 2] > 0
    normal = -normal[facing] / np.linalg.norm(normal[facing], axis=1, keepdims=True)
    light = 0.35 + 0.65 * np.clip(normal @ LIGHT / np.linalg.norm(LIGHT), 0, 1)
    corners = surface.elements[facing]
    return places[corners], depth[corners].mean(axis=1), np.clip(light[:, None] * colour, 0, 1)
