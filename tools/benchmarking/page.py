"""RESULTS.md from results.json: the machine, then a section per group of cases."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cases import CASES, SECTIONS
from layout import digits, table
from sections import BELOW, KERNEL_HEAD, TITLES

Row = dict[str, Any]
Results = dict[str, dict[str, Any]]  # by name of the case: "machine" and "rows"

HEAD = """# Speed

`tools/bench` measured these figures and wrote this page, in a quarter of an hour on two idle cores.
`tools/bench NAME...` replaces single cases, `tools/bench --list` names them. Accuracy is in
[scenes/RESULTS.md](../../scenes/RESULTS.md).

- *Wall* and *CPU*: the whole run with start, steps and output. Medians over the runs; runs of one case take turns.
- *A step*: from the begin of its first system to the end of its last, without frames. Mean over the steps, median over
  the runs.
- *Systems*: the three that take the largest shares of the time of all systems.
- *Peak memory*: that of the process, libraries and work space of the solvers included.
- *Method*: conforming (minamo's default) or equal order with their defaults, both with TPIC; equal order where a label
  names none. Particles per cell, unless a label says something else: 2 x 2, in three dimensions 3 x 3 x 3, in the large
  tank 4 x 4. Dynamic viscosity: 1e-3 Pa s.
"""
BUSY_TEXT = """\
Other programs used the processors while these sections were measured: {titles} (load before a case up to {load:.0f} on
{cpus} processors). Compare times only within a case, whose runs take turns, and CPU rather than wall time.
"""


def biggest_systems(systems: dict[str, float], count: int = 3) -> str:
    total = sum(systems.values()) or 1
    order = sorted(systems, key=lambda name: -systems[name])[:count]
    return ", ".join(f"{name} {100 * systems[name] / total:.0f} %" for name in order)


# Title of a column and what stands in it, for all whole runs.
COLUMNS: dict[str, Callable[[Row], str]] = {
    "run": lambda row: row["label"],
    "threads": lambda row: str(row["threads"]),
    "particles": lambda row: str(row["particles"]),
    "unknowns": lambda row: str(row["unknowns_max"]),
    "steps": lambda row: str(row["steps"]),
    "wall [s]": lambda row: digits(row["wall_s"]),
    "CPU per simulated second [s]": lambda row: digits(row["cpu_s"] / row["time"]),
    "a step [ms]": lambda row: digits(1e3 * row["step_s"]),
    "runs: from, to [ms]": lambda row: f"{row['runs']}: " + ", ".join(digits(1e3 * s) for s in row["step_s_range"]),
    "iterations: mean, max": lambda row: f"{row['iterations_mean']:.1f}, {row['iterations_max']:.0f}",
    "peak memory [MB]": lambda row: digits(1e-6 * row["peak_memory_bytes"]),
    "bytes per particle": lambda row: digits(row["peak_memory_bytes"] / row["particles"]),
    "systems": lambda row: biggest_systems(row["systems"]),
}


def run_table(rows: list[Row]) -> str:
    return table(COLUMNS, ([of_row(row) for of_row in COLUMNS.values()] for row in rows))


def machine_lines(results: Results) -> str:
    """One line where all cases ran on the same machine, else one per machine with its cases."""
    cases_of: dict[str, list[str]] = {}
    for name, result in results.items():
        cases_of.setdefault(", ".join(f"{key}: {value}" for key, value in result["machine"].items()), []).append(name)
    if len(cases_of) == 1:
        return f"{next(iter(cases_of))}.\n"
    return "".join(f"- {', '.join(names)}: {machine}.\n" for machine, names in cases_of.items())


def busy_lines(results: Results) -> str:
    """Sections with cases that had to share the processors; empty if there are none. The case before may have used all
    of them."""
    busy = [(case, results[case.name]) for case in CASES if case.name in results
            and results[case.name].get("load", 0) > 1.25 * int(results[case.name]["machine"]["cpus"])]
    if not busy:
        return ""
    titles = ", ".join(dict.fromkeys(TITLES[case.section] for case, _ in busy))
    most = max((result for _, result in busy), key=lambda result: result["load"])
    return "\n" + BUSY_TEXT.format(titles=titles, load=most["load"], cpus=most["machine"]["cpus"])


def section(name: str, results: Results) -> str:
    """Empty if nothing of it has been measured."""
    rows = [row for case in CASES if case.section == name and case.name in results
            for row in results[case.name]["rows"]]
    if not rows:
        return ""
    if "line" in rows[0]:
        return f"\n## {TITLES[name]}\n{KERNEL_HEAD}\n" + "".join(row["line"] + "\n" for row in rows)
    below = BELOW[name](rows)
    return f"\n## {TITLES[name]}\n\n{run_table(rows)}" + (f"\n{below}" if below else "")


def page(results: Results) -> str:
    return HEAD + f"\n{machine_lines(results)}" + busy_lines(results) + "".join(section(name, results) for name in SECTIONS)
