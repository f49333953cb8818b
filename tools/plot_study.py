#!/usr/bin/python3
"""Draws study.csv of `minamo study` as study.png: error against wall time, one line per method.

plot_study.py study.csv [--out study.png] [--title TITLE] [--error LABEL]
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


def read(path):
    """The parameters' names and the rows that have an error, numbers as numbers."""
    with open(path, newline="", encoding="utf-8") as file:
        reader = csv.DictReader(file)
        names = list(reader.fieldnames or [])
        if "error" not in names or "wall_s" not in names:
            sys.exit(f"{path}: not a study: columns error and wall_s are missing")
        parameters = names[: names.index("error")]
        rows = [row for row in reader if row["error"] and float(row["error"]) > 0 and float(row["wall_s"]) > 0]
    for row in rows:
        row["x"], row["y"] = float(row["wall_s"]), float(row["error"])
    return parameters, rows


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


def style(rows, parameters, line):
    """Colour by the first parameter, dashes and marker by the second, further ones by the marker."""
    places = [different(rows, name).index(value) for name, value in zip(parameters, line)] + [0, 0]
    # One parameter only: markers differ as well, for prints without colour.
    marker = places[0] if len(parameters) == 1 else places[1] + 2 * sum(places[2:])
    return {
        "color": COLOURS[places[0] % len(COLOURS)],
        "linestyle": DASHES[places[1] % len(DASHES)],
        "marker": MARKERS[marker % len(MARKERS)],
    }


def draw_lines(axes, parameters, rows):
    methods = [name for name in parameters if name != resolution(parameters, rows)]
    lines = {}
    for row in rows:
        lines.setdefault(tuple(row[name] for name in methods), []).append(row)
    for line, points in lines.items():
        label = ", ".join(text(name, value) for name, value in zip(methods, line)) or "all"
        axes.plot([p["x"] for p in points], [p["y"] for p in points], linewidth=1.4, markersize=5.5, label=label,
                  **style(rows, methods, line))


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


def label_axis(axis, values):
    """Labels at 1, 2 and 5 where powers of ten alone would be too few."""
    from matplotlib import ticker

    if max(values) < 300 * min(values):
        axis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(ticker.StrMethodFormatter("{x:g}"))
        axis.set_minor_formatter(ticker.NullFormatter())


def draw(parameters, rows, title, error, out):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(9.5, 5.5), layout="constrained")
    draw_lines(axes, parameters, rows)
    draw_frontier(axes, parameters, rows)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.margins(0.08)
    label_axis(axes.xaxis, [row["x"] for row in rows])
    label_axis(axes.yaxis, [row["y"] for row in rows])
    machine = f"{rows[0].get('cpu_model', '')}, threads: {rows[0].get('threads', '?')}"
    axes.set_xlabel(f"wall time of the time loop [s]\n({machine})")
    axes.set_ylabel(textwrap.fill(f"{error} [1]", 40))
    axes.set_title(title)
    axes.grid(which="major", color="0.85")
    axes.grid(which="minor", color="0.93", linewidth=0.5)
    axes.set_axisbelow(True)
    along = resolution(parameters, rows)
    note = f"\nnumbers at rings: {head(along)}" + (" along x" if along == "cells" else "") if along else ""
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1), frameon=False, fontsize=9, title="method" + note,
                title_fontsize=9, alignment="left")
    figure.savefig(out, dpi=150)


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("csv", type=pathlib.Path, help="study.csv")
    options.add_argument("--out", type=pathlib.Path, help="by default study.png beside it")
    options.add_argument("--title", default="")
    options.add_argument("--error", default="error", help="label of the axis, without unit")
    chosen = options.parse_args()
    parameters, rows = read(chosen.csv)
    if not rows:
        sys.exit(f"{chosen.csv}: no variant has an error > 0 to draw")
    try:
        title = chosen.title or chosen.csv.resolve().parent.name
        draw(parameters, rows, title, chosen.error, chosen.out or chosen.csv.with_name("study.png"))
    except ModuleNotFoundError as missing:
        sys.exit(f"{missing.name} is not installed: sudo apt-get install python3-matplotlib")


if __name__ == "__main__":
    main()
