"""What is measured on the particles after a step."""

from __future__ import annotations

from typing import Any

import numpy as np

from case import Gauge


def front(axis: int = 0) -> Gauge:
    """Place of the foremost particle's far edge along an axis. [m]"""

    def measure(sim: Any) -> float:
        x = sim["particle.position"][:, axis]
        edge = 0.5 * float(sim["particle.volume"][0]) ** (1 / sim.dimension)
        return float(x.max()) + edge

    return measure


def height(at: float, width: float, across: float = 1) -> Gauge:
    """Depth of the liquid around x = at, as a wire measures: its volume over its floor, the less the farther away. [m]

    `width` is from one end to the other [m], within the tank; `across` the extent of the tank along y, in 3-D [m].
    """

    def measure(sim: Any) -> float:
        x = sim["particle.position"][:, 0]
        weight = np.maximum(0, 1 - np.abs(x - at) / (width / 2)) / (width / 2)
        return float(weight @ sim["particle.volume"]) / across

    return measure


def mean_pressure(*probes: str) -> Gauge:
    """Of a plate that several probes cover. [Pa]"""

    def measure(sim: Any) -> float:
        return float(np.mean([sim.row[f"{probe}_pressure"] for probe in probes]))

    return measure
