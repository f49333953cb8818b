"""Our curves over the measured points: a panel per curve, a colour per resolution."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import numpy as np
from matplotlib.figure import Figure

from case import Case, Points, Result

COLOURS = ("#56b4e9", "#0072b2")
COLOURS_BESIDE = ("#999999", "#009e73")


def draw(case: Case, results: list[Result], beside: dict[str, dict[str, Points]], measured: dict[str, Points],
         file: Path) -> None:
    across = min(2, len(case.curves))
    down = -(-len(case.curves) // across)
    figure = Figure(figsize=(5.0 * across, 2.9 * down + 0.2), constrained_layout=True)
    panels = figure.subplots(down, across, squeeze=False).flatten()
    for panel in panels[len(case.curves):]:
        panel.set_axis_off()
    for panel, curve in zip(panels, case.curves):
        for result, colour in zip(results, COLOURS):
            ours = result.curves[curve.name]
            panel.plot(ours.x, ours.y, color=colour, linewidth=1.1, label=f"minamo, {result.resolution}")
        for (label, curves), colour in zip(beside.items(), COLOURS_BESIDE):
            panel.plot(curves[curve.name].x, curves[curve.name].y, color=colour, linewidth=0.9, label=label)
        points = measured[curve.name]
        dense = len(points.x) > 150
        panel.plot(points.x, points.y, color="#d55e00", linestyle="solid" if dense else "none", linewidth=0.9,
                   marker="none" if dense else "o", markersize=3, markerfacecolor="none", label="measured")
        panel.set_ylim(*limits(points, [result.curves[curve.name] for result in results]))
        panel.set_xlim(0, max(result.curves[curve.name].x[-1] for result in results))
        panel.set_title(curve.label, fontsize=9)
        panel.tick_params(labelsize=8)
    for panel in panels[max(0, len(case.curves) - across):len(case.curves)]:
        panel.set_xlabel(case.x_label, fontsize=9)
    panels[0].legend(fontsize=8, frameon=False)
    figure.savefig(file, dpi=80)


def limits(measured: Points, ours: list[Points]) -> tuple[float, float]:
    """Of what is drawn, without the spikes of a hundredth of the steps."""
    low = min([float(measured.y.min())] + [float(np.quantile(points.y, 0.01)) for points in ours])
    high = max([float(measured.y.max())] + [float(np.quantile(points.y, 0.99)) for points in ours])
    margin = 0.06 * (high - low)
    return low - margin, high + margin
