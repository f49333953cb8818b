"""How fast liquid at rest moves over time, by quadrature: a colour per scene, dashed with forces by particles."""

from __future__ import annotations

from matplotlib.figure import Figure

from figuring.plots import COLOURS, STYLES, quiet
from reporting.runs import Run

LINES = {"exact": STYLES[0], "mixed": STYLES[1]}


def draw_rest(runs: dict[tuple[str, str], Run], width: float) -> Figure:
    """`runs` by label and quadrature."""
    figure = Figure(figsize=(width, 0.5 * width), constrained_layout=True)
    axes = figure.subplots()
    labels = list(dict.fromkeys(label for label, _ in runs))
    for (label, quadrature), run in runs.items():
        # At the start all of it rests, which has no logarithm.
        axes.plot(run.history["time"][1:], run.series("max_speed")[1:], linewidth=1.2, linestyle=LINES[quadrature],
                  color=COLOURS[labels.index(label)], label=f"{label}, {quadrature}")
    axes.set_yscale("log")
    axes.set_xlabel("$t$ [s]", fontsize=9)
    axes.set_ylabel("fastest particle [m/s]", fontsize=9)
    quiet(axes)
    axes.legend(frameon=False, fontsize=7.5, ncols=2, loc="lower center", bbox_to_anchor=(0.5, 1))
    return figure
