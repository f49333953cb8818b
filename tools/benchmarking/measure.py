"""Runs cases and reads what the runs leave behind."""

from __future__ import annotations

import csv
import json
import os
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path
from statistics import mean, median
from typing import Any

from cases import Case, Run

ROOT = Path(__file__).resolve().parents[2]
OUTPUT_SYSTEMS = {"flush_history", "recover_pressure", "sample_pressure", "write_frame", "write_bodies",
                  "write_velocity_gradient", "write_xdmf"}

Measured = dict[str, Any]


class BenchmarkFailed(Exception):
    """A program did not do what was asked of it."""


def call(command: list[str]) -> str:
    """What the program prints; BLAS keeps to one thread."""
    done = subprocess.run(command, env=os.environ | {"OPENBLAS_NUM_THREADS": "1"}, text=True, cwd=ROOT,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    if done.returncode != 0:
        said = (done.stderr or done.stdout).strip()
        raise BenchmarkFailed(f"{' '.join(command)}: exit code {done.returncode}\n{said}")
    return done.stdout


def run_once(program: Path, run: Run, folder: Path) -> Measured:
    """One call of `minamo run`."""
    command = [str(program), "run", f"scenes/{run.scene}.json", "--threads", str(run.threads), "--quiet", "--profile",
               "--overwrite", "--out", str(folder)]
    if run.steps:
        command += ["--steps", str(run.steps)]
    for pointer, value in run.overrides.items():
        command += ["--set", f"{pointer}={json.dumps(value)}"]
    call(command)
    summary = json.loads((folder / "summary.json").read_text())
    iterations = [float(row["iterations"]) for row in history(folder)[1:]]  # the first row is the start
    measured = {key: summary[key] for key in ("wall_s", "cpu_s", "time", "steps", "particles", "unknowns_max",
                                              "peak_memory_bytes")}
    measured["version"] = summary["version"]
    measured["step_s"] = step_seconds(json.loads((folder / "trace.json").read_text())["traceEvents"],
                                        summary["steps"])
    measured["iterations_mean"] = mean(iterations)
    measured["iterations_max"] = max(iterations)
    of_steps = [row for row in summary["systems"] if row["name"] not in OUTPUT_SYSTEMS]
    measured["systems"] = {row["name"]: row["seconds"] for row in of_steps}
    measured["declared_bytes"] = {row["name"]: row["declared_bytes"] for row in of_steps}
    return measured


def history(folder: Path) -> list[dict[str, str]]:
    """The rows of history.csv."""
    with open(folder / "history.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def step_seconds(events: list[dict[str, Any]], steps: int | None = None) -> float:
    """Wall time per step, from the begin of its first system to the end of its last; what went into steps that were
    taken back is in it. Frames are left out. The events are in the order of their begin. Without a number of steps, it
    is the number of calls of the system that is called least."""
    calls: Counter[str] = Counter()
    tries: list[dict[str, dict[str, Any]]] = [{}]  # by system
    for event in events:
        name = event["name"]
        if name in OUTPUT_SYSTEMS:
            continue
        if name in tries[-1]:
            tries.append({})
        tries[-1][name] = event
        calls[name] += 1
    spans = (max(e["ts"] + e["dur"] for e in one.values()) - min(e["ts"] for e in one.values()) for one in tries)
    return 1e-6 * sum(spans) / (steps or min(calls.values()))


def median_of(measured: list[Measured]) -> Measured:
    """Every number by itself."""
    middle: Measured = {}
    for key, first in measured[0].items():
        values = [one[key] for one in measured]
        if isinstance(first, dict):
            middle[key] = median_of(values)
        else:
            middle[key] = type(first)(median(values)) if isinstance(first, (int, float)) else first
    return middle


def distances(folder: Path) -> dict[str, float]:
    """Share of the water that is not where interFoam has it, by time [s]; empty where numpy or h5py is missing."""
    command = [sys.executable, str(ROOT / "tools/compare_interfoam.py"), str(folder)]
    done = subprocess.run(command, text=True, capture_output=True, check=False)
    if done.returncode != 0:
        print(f"  not compared with interFoam: {done.stderr.strip()}", file=sys.stderr)
        return {}
    times, found = done.stdout.splitlines()
    pairs = zip(re.findall(r"\d+\.\d+", times), found.removeprefix(folder.name).split())
    return {time: float(value) for time, value in pairs if value != "-"}


def energy_difference(folder: Path, reference: Path) -> dict[str, float]:
    """Largest relative difference over the rows of two histories, by column."""
    rows = list(zip(history(folder), history(reference)))
    worst = {}
    for column in ("kinetic_energy", "potential_energy"):
        pairs = [(float(a[column]), float(b[column])) for a, b in rows]
        worst[column] = max((abs(a - b) / abs(b) for a, b in pairs if b != 0), default=0.0)
    return worst


def measure(case: Case, program: Path, repeat: int, folder: Path) -> list[Measured]:
    """Medians, a row for every run of the case. The runs take turns."""
    times = min(repeat, case.repeat_at_most or repeat)
    measured: list[list[Measured]] = [[] for _ in case.runs]
    folders = [folder / f"{case.name}_{k}" for k in range(len(case.runs))]
    for _ in range(times):
        for k, run in enumerate(case.runs):
            measured[k].append(run_once(program, run, folders[k]))
    rows = []
    for k, run in enumerate(case.runs):
        row = {"label": run.label, "threads": run.threads, "runs": times, **median_of(measured[k])}
        row["step_s_range"] = [pick(one["step_s"] for one in measured[k]) for pick in (min, max)]
        if run.compare:
            row["distances"] = distances(folders[k])
        if k > 0:
            row["difference"] = energy_difference(folders[0], folders[k])
        rows.append(row)
    return rows


def measure_kernels(program: Path, quick: bool) -> list[Measured]:
    """The lines of the table that the micro-benchmarks print."""
    command = [str(program), "[roofline]", "--benchmark-samples", "1" if quick else "11"]
    lines = [line for line in call(command).splitlines() if line.startswith("|")]
    if not lines:
        raise BenchmarkFailed(f"{' '.join(command)} prints no table")
    return [{"line": line} for line in lines]
