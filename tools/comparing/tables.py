"""What tools/compare prints and writes to compare.csv."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from comparing.comparison import Comparison
from comparing.convergence import USUAL, Figure
from comparing.histories import Difference
from reporting.facts import differing_keys
from reporting.runs import Run, labels

NOTHING = "–"
WIDEST = 40  # of a value of a scene


def text_of(comparison: Comparison) -> str:
    """All tables, one below the other."""
    names = labels(comparison.runs)
    parts = [_runs_table(comparison.runs, names)]
    parts += [_differences_table(comparison, k, names) for k in range(len(comparison.runs) - 1)]
    parts += [_liquid_table(comparison, names)]
    parts += [_orders_table(comparison.figures)] if comparison.figures else []
    return "\n\n".join(parts)


def aligned(rows: list[list[str]]) -> str:
    """Columns of equal width, the first to the left, the others to the right."""
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    return "\n".join(f"{row[0]:{widths[0]}}  " + "  ".join(f"{cell:>{width}}" for cell, width in
                                                           zip(row[1:], widths[1:])) for row in rows)


def _short(value: str) -> str:
    return value if len(value) <= WIDEST else value[:WIDEST - 1] + "…"


def _runs_table(runs: list[Run], names: list[str]) -> str:
    differing = [[_short(cell) for cell in row] for row in differing_keys(runs)]
    summaries = [run.summary for run in runs]
    facts = [["steps", *(f"{summary['steps']}" for summary in summaries)],
             ["particles", *(f"{summary['particles']}" for summary in summaries)],
             ["CPU time [s]", *(f"{summary['cpu_s']:.3g}" for summary in summaries)],
             ["wall time [s]", *(f"{summary['wall_s']:.3g}" for summary in summaries)],
             ["threads", *(f"{summary['threads']}" for summary in summaries)]]
    same = "" if differing else "\nThe scenes are the same."
    return aligned([["", *map(_short, names)], *differing, *facts]) + same


def _percent(value: float) -> str:
    return f"{100 * value:.3g} %" if np.isfinite(value) else NOTHING


def _differences_table(comparison: Comparison, k: int, names: list[str]) -> str:
    head = ["column", "unit", "range", "rms", "largest", "at [s]"]
    rows = [[each.column, each.unit, f"{each.range:.4g}", _percent(each.relative(each.rms)),
             _percent(each.relative(each.largest)), f"{each.time:.4g}"] for each in comparison.differences[k]]
    return (f"{names[k]} less {names[-1]}, from 0 to {comparison.end:.6g} s, in parts of the range of {names[-1]}:\n"
            + aligned([head, *rows]))


def _liquid_table(comparison: Comparison, names: list[str]) -> str:
    liquid = comparison.liquid
    if liquid is None:
        return f"No misplaced area: {comparison.no_liquid}."
    head = ["S", "mean", "largest", "at [s]", f"at {liquid.times[-1]:.4g} s"]
    rows = [[name, f"{np.nanmean(shares):.4f}", f"{np.nanmax(shares):.4f}",
             f"{liquid.times[np.nanargmax(shares)]:.4g}", f"{shares[-1]:.4f}"]
            for name, shares in zip(map(_short, names), liquid.shares.T) if np.isfinite(shares).any()]
    resolution = f"pixels of {liquid.raster.pixel:.4g} m, B-spline of {liquid.raster.width:.4g} m"
    return (f"Misplaced area S, liquid in one of the two alone over that of {names[-1]}, {len(liquid.times)} frames;\n"
            f"{resolution}:\n{aligned([head, *rows])}")


def _orders_table(figures: list[Figure]) -> str:
    head = ["figure", "", "coarse", "middle", "fine", "order", "extrapolated", "GCI"]
    rows, remarks = [], []
    for each in figures:
        values = [f"{value:.5g}" for value in each.values]
        if each.convergence == "monotone":
            rows.append([each.column, each.kind, *values, f"{each.order:.2f}", f"{each.extrapolated:.5g}",
                         _percent(each.index)])
            if not each.is_usual:
                remarks.append(f"  {each.column} {each.kind}: an order of {each.order:.2f} is by chance; expected: "
                               f"{USUAL[0]:g} to {USUAL[1]:g}")
        else:
            rows.append([each.column, each.kind, *values, NOTHING, NOTHING, NOTHING])
            remarks.append(f"  {each.column} {each.kind}: {each.convergence}")
    text = (f"Three grids, each {figures[0].ratio:.4g} times as fine as the one before; order, Richardson's value, "
            "grid convergence index:\n" + aligned([head, *rows]))
    return "\n".join([text, *remarks])


def write_csv(path: Path, comparison: Comparison) -> None:
    """A number per line: what it is a figure of, what figure, its time if it has one."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["run", "against", "quantity", "unit", "figure", "time", "value"])
        writer.writerows(_numbers(comparison))


def _numbers(comparison: Comparison) -> Iterator[list]:
    against = str(comparison.last.folder)
    for run, differences in zip(comparison.runs, comparison.differences):
        for each in differences:
            yield from ([str(run.folder), against, each.column, *row] for row in _difference_numbers(each))
    liquid = comparison.liquid
    if liquid:
        yield [against, "", "raster", "m", "pixel", "", liquid.raster.pixel]
        yield [against, "", "raster", "m", "width of the B-spline", "", liquid.raster.width]
        for run, shares in zip(comparison.runs, liquid.shares.T):
            for time, share in zip(liquid.times, shares):
                yield [str(run.folder), against, "misplaced_area", "1", "S", time, share]
    for each in comparison.figures:
        unit = comparison.last.units.get(each.column, "")
        for name, value in zip(("coarse", "middle", "fine"), each.values):
            yield ["", "", each.column, unit, f"{each.kind}, {name}", "", value]
        if each.convergence == "monotone":
            yield ["", "", each.column, "1", f"{each.kind}, order", "", each.order]
            yield ["", "", each.column, unit, f"{each.kind}, extrapolated", "", each.extrapolated]
            yield ["", "", each.column, "1", f"{each.kind}, grid convergence index", "", each.index]


def _difference_numbers(each: Difference) -> Iterator[list]:
    yield [each.unit, "range", "", each.range]
    yield [each.unit, "rms", "", each.rms]
    yield [each.unit, "largest", each.time, each.largest]
    yield ["1", "rms over range", "", each.relative(each.rms)]
    yield ["1", "largest over range", each.time, each.relative(each.largest)]
