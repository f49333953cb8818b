#!/usr/bin/env python3
"""How much water moves that should rest beside bodies, where angles, places, levels and grids are drawn by chance.

    tests/rest_by_chance.py PROGRAM [--count 33] [--first 1] [--end 20] [--kinds beach,tank,...] [--step 1] [--keep DIR]

Pools on a beach, in a tank along the grid, around a post at an angle and in a tank at an angle, one of each for every
number from --first on; the same number always gives the same pool. Two to four particles per cell and direction, along
a lattice or cut, spacings of 2.5 to 5 cm. Prints the largest speed from half a second on, and how many pools move by
more than 0.02 m/s. --step shortens the default step. Ends with 1 if a run fails.
"""

import argparse
import concurrent.futures
import csv
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile

REST = 0.02  # [m/s]
SETTLED = 0.5  # [s]


def turned(points, centre, angle):
    """Points of a polygon, turned about a centre."""
    c, s = math.cos(angle), math.sin(angle)
    return [[centre[0] + c * (x - centre[0]) - s * (y - centre[1]), centre[1] + s * (x - centre[0]) + c * (y - centre[1])]
            for x, y in points]


def grid(low, cells, spacing):
    return {"low": low, "high": [a + n * spacing for a, n in zip(low, cells)], "cells": cells}


def level(height):
    return {"half_space": {"point": [0, height], "normal": [0, 1]}}


def beach(draw, fine):
    h = 0.05 / fine
    foot = draw.uniform(0.9, 1.2)
    slope = draw.choice([draw.uniform(0.1, 0.4), draw.uniform(0.4, 1), draw.uniform(1, 3)])
    body = {"half_space": {"point": [foot, 0], "normal": [-slope, 1]}}
    return grid([0, 0], [round(40 * fine), round(12 * fine)], h), body, level(draw.uniform(0.2, 0.4))


def tank(draw, fine):
    h = 0.05 / fine
    low = [-0.2 - draw.uniform(0, 1) * h, -0.2 - draw.uniform(0, 1) * h]
    body = {"invert": {"box": {"low": [0, 0], "high": [1, 0.6]}}}
    water = {"box": {"low": [0, 0], "high": [1, draw.uniform(0.25, 0.45)]}}
    return grid(low, [round(28 * fine), round(20 * fine)], h), body, water


def post(draw, fine):
    h = 0.05 / fine
    x, y = draw.uniform(0, 1) * h, draw.uniform(0, 1) * h
    angle = draw.choice([0, draw.uniform(0, 1.5)])
    corners = [[0.5 + x, -0.2 - y], [0.9 + x, -0.2 - y], [0.9 + x, 0.8], [0.5 + x, 0.8]]
    body = {"polygon": {"vertices": turned(corners, [0.7 + x, 0.3], angle)}}
    return grid([0, 0], [round(32 * fine), round(20 * fine)], h), body, level(draw.uniform(0.3, 0.5))


def turned_tank(draw, fine):
    h = 0.05 / fine
    angle = draw.uniform(-0.8, 0.8)
    height = draw.uniform(0.3, 0.6)
    off = draw.uniform(0, 1) * h
    corners = [[0.1, 0.1 + off], [0.9, 0.1 + off], [0.9, 0.9], [0.1, 0.9]]
    body = {"invert": {"polygon": {"vertices": turned(corners, [0.5, 0.5], angle)}}}
    return grid([-0.1 + off, -0.1], [round(24 * fine)] * 2, h), body, level(height)


KINDS = {kind.__name__: kind for kind in (beach, tank, post, turned_tank)}


def pool(kind, number, end, step):
    """The scene of a pool."""
    draw = random.Random(f"{kind}{number}")
    per_cell = draw.choice([2, 3, 4])
    of_grid, body, water = KINDS[kind](draw, draw.choice([1, 1, 1.5, 2]))
    spacing = (of_grid["high"][0] - of_grid["low"][0]) / of_grid["cells"][0]
    time = {"end": end}
    if step < 1:
        time["max_step"] = step * math.sqrt(spacing / 9.81) / 6
    return {"dimension": 2, "grid": of_grid, "walls": draw.choice(["slip", "no_slip"]),
            "fluid": {"density": 1000, "viscosity": 1e-3}, "body_force": [0, -9.81],
            "bodies": [{"name": "body", "shape": body}], "time": time, "output": {"every": end},
            "particles": [{"shape": water, "per_cell": per_cell, "arrangement": draw.choice(["lattice", "cut"])}]}


def unrest(program, scene, folder):
    """Largest speed from when the start has settled, and its time; None and what is said if the run fails."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "scene.json"
    path.write_text(json.dumps(scene, indent=1), encoding="utf8")
    done = subprocess.run([program, "run", path, "--out", folder / "run", "--threads", "1", "--quiet", "--overwrite"],
                          capture_output=True, text=True, check=False)
    if done.returncode:
        return None, done.stderr
    with open(folder / "run/history.csv", encoding="utf8") as file:
        rows = [(float(row["max_speed"]), float(row["time"])) for row in csv.DictReader(file)]
    return max(row for row in rows if row[1] >= SETTLED)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--count", type=int, default=33, help="pools of every kind")
    parser.add_argument("--first", type=int, default=1, help="number of the first one")
    parser.add_argument("--end", type=float, default=20, help="length of a run, more than half a second [s]")
    parser.add_argument("--kinds", default=",".join(KINDS), help="which, separated by commas")
    parser.add_argument("--step", type=float, default=1, help="largest step over that of the program, at most 1")
    parser.add_argument("--keep", type=pathlib.Path, help="folder that keeps scenes and results")
    arguments = parser.parse_args()
    kinds = arguments.kinds.split(",")
    unknown = [kind for kind in kinds if kind not in KINDS]
    if unknown:
        parser.error(f"no kind of pool: {', '.join(unknown)}; there are {', '.join(KINDS)}")
    if arguments.end <= SETTLED:
        parser.error(f"--end: {arguments.end} s are over before the start has settled, after {SETTLED} s")
    pools = [(kind, number) for number in range(arguments.first, arguments.first + arguments.count) for kind in kinds]
    moving = failed = 0
    with tempfile.TemporaryDirectory() as scratch, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as runs:

        def run(of):
            scene = pool(*of, arguments.end, arguments.step)
            return unrest(arguments.program, scene, (arguments.keep or pathlib.Path(scratch)) / f"{of[0]}_{of[1]}")

        for (kind, number), (speed, other) in zip(pools, runs.map(run, pools)):
            if speed is None:
                failed += 1
                print(f"{kind} {number}: fails: {other}", flush=True)
                continue
            moving += speed > REST
            print(f"{kind} {number}: {speed:.2g} m/s at {other:.3g} s{', moves' if speed > REST else ''}", flush=True)
    print(f"{moving} of {len(pools)} pools move, {failed} fail")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
