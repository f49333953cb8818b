#!/usr/bin/python3
"""Draws study.csv of `minamo study` as study.png: error against wall time or processor time, one line per method.

The parameter with the most values is shown by colours, the next by dashes, a third by markers.

plot_study.py study.csv [--out study.png] [--title TITLE] [--error LABEL] [--cost COLUMN] [--others TABLE]
"""

import argparse
import csv
import pathlib
import sys
import textwrap

# Okabe and Ito: colours that everybody can tell apart. Black is last because the frontier is dark as well.
COLOURS = ["#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#56B4E9", "#F0E442", "#000000"]
MARKERS = ["o", "s", "^", "D", "v", "P", "X", "*"]
DASHES = ["-", "--", ":", "-."]
COSTS = {"wall_s": "wall time of the time loop [s]", "cpu_per_s": "processor time of a simulated second [s]"}


def read(path, cost):
    """The parameters' names and the rows that have an error, numbers as numbers."""
    with open(path, newline="", encoding="utf-8") as file:
        reader = csv.DictReader(file)
        names = list(reader.fieldnames or [])
        if "error" not in names or cost not in names:
            sys.exit(f"{path}: not a study: columns error and {cost} are missing")
        parameters = names[: names.index("error")]
        rows = [row for row in reader if row["error"] and float(row["error"]) > 0 and float(row[cost]) > 0]
    for row in rows:
        row["x"], row["y"] = float(row[cost]), float(row["error"])
    return parameters, rows


def read_others(path):
    """Points of others by code: lists of cost, error."""
    codes = {}
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            codes.setdefault(row["code"], []).append((float(row["cost"]), float(row["error"])))
    return codes


def different(rows, name):
    """The values of a parameter, in the order in which they come."""
    return list(dict.fromkeys(row[name] for row in rows))


def resolution(parameters, rows):
    """What varies along a line: the cells, else the first parameter that is a number; none without either."""
    numbers = [name for name in parameters if all(is_number(value) for value in different(rows, name))]
    return "cells" if "cells" in parameters else next(iter(numbers), None)


def is_number(value):
    try:
        float(value)
    except ValueError:
        return False
    return True


def head(name):
    return name.removesuffix("/scheme").rsplit("/", 1)[-1]


def text(name, value):
    """A word speaks for itself; a number says what it is of."""
    return f"{head(name)} {value}" if value[:1] in "0123456789-[" else value


def ranked(rows, methods):
    """Parameters of a line, that with the most values first: it gets the colours."""
    return sorted(methods, key=lambda name: -len(different(rows, name)))


def looks(rows, methods):
    """Per parameter and value what shows it: colour, dashes, marker, in the order of ranked(); further ones share the
    marker."""
    palettes = [("color", COLOURS), ("linestyle", DASHES), ("marker", MARKERS)]
    found = {}
    for place, name in enumerate(ranked(rows, methods)):
        what, palette = palettes[min(place, 2)]
        values = different(rows, name)
        if len(values) > len(palette):
            sys.exit(f"{name} has {len(values)} values, but there are {len(palette)} to show them by {what}")
        found[name] = {value: {what: palette[k]} for k, value in enumerate(values)}
    return found


def style(line, look, methods, rows):
    """Where nothing else needs the markers, they repeat the colour, for prints without."""
    chosen = {"color": COLOURS[0], "linestyle": DASHES[0], "marker": MARKERS[0]}
    order = ranked(rows, methods)
    if order and len(order) < 3:
        colours = list(look[order[0]])
        chosen["marker"] = MARKERS[colours.index(line[methods.index(order[0])])]
    for name, value in zip(methods, line):
        chosen |= look[name][value]
    return chosen


def draw_lines(axes, parameters, rows):
    methods = [name for name in parameters if name != resolution(parameters, rows)]
    look = looks(rows, methods)
    lines = {}
    for row in rows:
        lines.setdefault(tuple(row[name] for name in methods), []).append(row)
    for line, points in lines.items():
        axes.plot([p["x"] for p in points], [p["y"] for p in points], linewidth=1.4, markersize=5.5,
                  **style(line, look, methods, rows))


def keys(parameters, rows):
    """Lines of the legend: a heading per parameter, below it what shows each value."""
    from matplotlib.lines import Line2D

    methods = [name for name in parameters if name != resolution(parameters, rows)]
    look = looks(rows, methods)
    entries = []
    for place, name in enumerate(ranked(rows, methods)):
        entries.append(Line2D([], [], linestyle="none", label=f"$\\bf{{{head(name).replace('_', chr(92) + '_')}}}$"))
        for value, shown in look[name].items():
            base = {"color": "0.25", "linestyle": "none" if place >= 2 else "-", "marker": "none"}
            if place == 0 and len(methods) < 3:
                base["marker"] = MARKERS[list(look[name]).index(value)]
            entries.append(Line2D([], [], linewidth=1.4, markersize=5.5, label=text(name, value), **base | shown))
    return entries


def draw_frontier(axes, parameters, rows):
    frontier = sorted((row for row in rows if row.get("frontier") == "1"), key=lambda row: row["x"])
    axes.plot([p["x"] for p in frontier], [p["y"] for p in frontier], color="0.25", linewidth=5, alpha=0.25,
              drawstyle="steps-post", zorder=1)
    axes.plot([p["x"] for p in frontier], [p["y"] for p in frontier], linestyle="none", marker="o", markersize=12,
              markerfacecolor="none", markeredgecolor="0.2", markeredgewidth=1.6,
              label="frontier: none is both\nfaster and more accurate")
    along = resolution(parameters, rows)
    for p in frontier if along else []:
        axes.annotate(p[along], (p["x"], p["y"]), xytext=(-8, -8), textcoords="offset points", ha="right",
                      va="top", fontsize=8, color="0.2")


def draw_others(axes, codes):
    """Grey marks, a shape per code: who is compared with stays behind what is compared."""
    for marker, (code, points) in zip(["x", "+", "1", "2", "3", "4", "|", "_"] * len(codes), codes.items()):
        axes.plot(*zip(*points), linestyle="none", marker=marker, markersize=8, markeredgewidth=1.8, color="0.35",
                  label=code)


def label_axis(axis, values):
    """Labels at 1, 2 and 5 where powers of ten alone would be too few."""
    from matplotlib import ticker

    if max(values) < 300 * min(values):
        axis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(ticker.StrMethodFormatter("{x:g}"))
        axis.set_minor_formatter(ticker.NullFormatter())


def draw(parameters, rows, title, error, out, cost, others):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(9.5, 5.5), layout="constrained")
    draw_lines(axes, parameters, rows)
    draw_frontier(axes, parameters, rows)
    draw_others(axes, others)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.margins(0.08)
    beside = [point for points in others.values() for point in points]
    label_axis(axes.xaxis, [row["x"] for row in rows] + [x for x, _ in beside])
    label_axis(axes.yaxis, [row["y"] for row in rows] + [y for _, y in beside])
    machine = f"{rows[0].get('cpu_model', '')}, threads: {rows[0].get('threads', '?')}"
    axes.set_xlabel(f"{COSTS[cost]}\n({machine})")
    axes.set_ylabel(textwrap.fill(f"{error} [1]", 60))
    axes.set_title(textwrap.fill(title, 50))
    axes.grid(which="major", color="0.85")
    axes.grid(which="minor", color="0.93", linewidth=0.5)
    axes.set_axisbelow(True)
    along = resolution(parameters, rows)
    note = f"\nnumbers at rings: {head(along)}" + (" along x" if along == "cells" else "") if along else ""
    frontier = axes.get_legend_handles_labels()[0]  # and others; the lines have no label of their own
    axes.legend(handles=keys(parameters, rows) + frontier, loc="upper left", bbox_to_anchor=(1.01, 1), frameon=False, fontsize=9, title=note.strip() or None,
                title_fontsize=9, alignment="left")
    figure.savefig(out, dpi=150)


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("csv", type=pathlib.Path, help="study.csv")
    options.add_argument("--out", type=pathlib.Path, help="by default study.png next to it")
    options.add_argument("--title", default="")
    options.add_argument("--error", default="error", help="label of the axis, without unit")
    options.add_argument("--cost", choices=list(COSTS), default="wall_s", help="column of the axis")
    options.add_argument("--others", type=pathlib.Path, help="points of others: columns code, cost, error")
    chosen = options.parse_args()
    parameters, rows = read(chosen.csv, chosen.cost)
    if not rows:
        sys.exit(f"{chosen.csv}: no variant has an error > 0 to draw")
    try:
        title = chosen.title or chosen.csv.resolve().parent.name
        draw(parameters, rows, title, chosen.error, chosen.out or chosen.csv.with_name("study.png"), chosen.cost,
             read_others(chosen.others) if chosen.others else {})
    except ModuleNotFoundError as missing:
        sys.exit(f"{missing.name} is not installed: sudo apt-get install python3-matplotlib")


if __name__ == "__main__":
    main()
