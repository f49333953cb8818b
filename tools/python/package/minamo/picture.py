"""A look at the particles."""

from __future__ import annotations

import io

import numpy as np

_units = {"speed": "m/s", "particle.pressure": "Pa"}


def _colors(sim, color: str) -> np.ndarray:
    if color == "speed":
        return np.linalg.norm(sim["particle.velocity"], axis=1)
    return sim[color]


def show(sim, color: str = "speed", ax=None):
    import matplotlib.pyplot as plt

    x = sim["particle.position"]
    values = _colors(sim, color)
    across, up = 0, sim.dimension - 1
    # What is nearer to who looks along y is drawn later.
    order = np.argsort(-x[:, 1], kind="stable") if sim.dimension == 3 else slice(None)
    if ax is None:
        ax = plt.subplots(figsize=(6, 4), layout="constrained")[1]
    grid = sim.grid
    ax.set(xlim=(grid["low"][across], grid["high"][across]), ylim=(grid["low"][up], grid["high"][up]), aspect="equal",
           xlabel="x [m]", ylabel="yz"[up - 1] + " [m]", title=f"t = {sim.time:.4g} s")
    size = 72 / ax.figure.dpi * _pixels(sim, ax)
    dots = ax.scatter(x[order, across], x[order, up], c=values[order], s=size**2, linewidths=0)
    unit = _units.get(color) or sim.columns[color]["unit"]
    ax.figure.colorbar(dots, ax=ax, label=f"{color} [{unit}]")
    return ax


def _pixels(sim, ax) -> float:
    """Width of a dot, such that the dots of a full cell touch."""
    grid = sim.grid
    per_direction = max(1.0, (len(sim["particle.mass"]) / max(1, _full_cells(sim))) ** (1 / sim.dimension))
    cells = max(grid["cells"][0], 1)
    width = ax.get_window_extent().width
    return max(1.0, 0.8 * width / cells / per_direction)


def _full_cells(sim) -> int:
    """Cells that hold a particle."""
    grid = sim.grid
    cell = ((sim["particle.position"] - grid["low"]) / grid["spacing"]).astype(int)
    return len(np.unique(cell, axis=0))


def live(sim, color: str):
    """Draws the simulation in a notebook. Returns what draws it anew in the same place."""
    from IPython.display import Image, display

    handle = display(Image(png(sim, color)), display_id=True)
    return lambda: handle.update(Image(png(sim, color)))


def png(sim, color: str = "speed") -> bytes:
    import matplotlib.pyplot as plt

    ax = show(sim, color)
    buffer = io.BytesIO()
    ax.figure.savefig(buffer, format="png", dpi=100)
    plt.close(ax.figure)
    return buffer.getvalue()
