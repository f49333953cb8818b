#!/usr/bin/env python3
"""Whether runs on several ranks are those of one process.

    tests/same_on_ranks.py PROGRAM MPI_PROGRAM [--ranks 2 3 4 8] [--steps 20] [--within 1e-9] [--twice] [SCENE]...

PROGRAM is minamo, MPI_PROGRAM minamo-mpi; every scene of scenes/ by default, in so many steps with a tolerance of the
solver of 1e-12. For every scene and number of ranks a line: largest difference of positions [h], of velocities [h per
step], of energies [of the largest energy], and until which time energies and steps agree within what --within
says: where flow is chaotic, they do not for ever. Particles and their numbers have to be the same. With --twice every
number of ranks runs twice, and the columns of the two checkpoints have to be the same, bit for bit. Scenes that are
refused on ranks are named. Ends with 0 if nothing differs by more, 1 if something does or fails, 2 if nothing was
compared.
"""

import argparse
import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import h5py
import numpy as np

import same_bits

ENERGIES = ("kinetic_energy", "potential_energy", "surface_energy")
REFUSED = 2


def run(program, scene, arguments, out):
    """The exit code, and what the run says where it fails."""
    command = [*program, "run", scene, "--steps", str(arguments.steps), "--out", out, "--threads", "1", "--quiet",
               "--set", '/output/precision="double"', "--set", '/solver={"tolerance": 1e-12}']
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.returncode, done.stderr if done.returncode else ""


def on_ranks(program, ranks):
    as_root = ["--allow-run-as-root"] if os.geteuid() == 0 else []
    return [shutil.which("mpiexec") or "mpirun", "-n", str(ranks), "--oversubscribe", *as_root, program]


def history(folder):
    with open(f"{folder}/history.csv", encoding="utf8") as file:
        rows = list(csv.DictReader(file))
    return {key: np.array([float(row[key] or "nan") for row in rows]) for key in rows[0]}


def particles(folder):
    """Those of the last frame, by their numbers."""
    with h5py.File(f"{folder}/fields.h5") as file:
        frames = file["particles"]
        frame = frames[max(frames, key=int)]
        order = np.argsort(frame["id"][:])
        return {name: frame[name][:][order] for name in ("id", "position", "velocity")}


def size_of(values):
    """The largest absolute value; of none, or of what is not known, 0."""
    values = np.abs(values[np.isfinite(values)])
    return float(values.max()) if values.size else 0.0


def spacing_of(folder):
    grid = json.loads(pathlib.Path(f"{folder}/scene.json").read_text(encoding="utf8"))["grid"]
    return (grid["high"][0] - grid["low"][0]) / grid["cells"][0]


def apart(ours, theirs, within):
    """Largest difference of energies of two histories, and the time to which energies and steps are the same."""
    names = [name for name in ENERGIES if name in theirs]
    energy = max(size_of(theirs[name]) for name in names) or 1.0
    rows = min(len(ours["time"]), len(theirs["time"]))
    scales = dict.fromkeys(names, energy) | {"time": theirs["time"][-1]}
    of_row = np.max([np.abs(ours[name][:rows] - theirs[name][:rows]) / scale for name, scale in scales.items()], axis=0)
    same = rows if not np.any(of_row > within) else int(np.argmax(of_row > within))
    return size_of(of_row), theirs["time"][max(same - 1, 0)]


def differences(alone, ranks, within):
    """Of positions, velocities and energies, and until when the runs agree; text if the particles are not the same."""
    ours, theirs = history(ranks), history(alone)
    mine, expected = particles(ranks), particles(alone)
    if not np.array_equal(mine["id"], expected["id"]):
        return f"{len(mine['id'])} particles, {len(expected['id'])} of one process, or other numbers"
    h = spacing_of(alone)
    return (size_of(mine["position"] - expected["position"]) / h,
            size_of(mine["velocity"] - expected["velocity"]) * theirs["dt"][-1] / h,
            *apart(ours, theirs, within))


def compare(scene, arguments, folder):
    """Runs a scene by one process and on ranks. Yields a number of ranks, whether that is alike, and a text."""
    code, said = run([arguments.program], scene, arguments, f"{folder}/alone")
    if code != 0:
        yield 0, False, f"fails: {said.strip()}"
        return
    for ranks in arguments.ranks:
        program = on_ranks(arguments.mpi_program, ranks)
        code, said = run(program, scene, arguments, f"{folder}/{ranks}")
        if code == REFUSED:
            yield ranks, None, "refused: " + ", ".join(sorted({line.split('"')[1] for line in said.splitlines()
                                                               if line.strip().startswith("got ")}))
            return
        if code != 0:
            yield ranks, False, f"exit code {code}: {said.strip()}"
            continue
        found = differences(f"{folder}/alone", f"{folder}/{ranks}", arguments.within)
        if isinstance(found, str):
            yield ranks, False, found
            continue
        text = "{:.1e} h, {:.1e} h per step, {:.1e} of the energy, alike until {:g} s".format(*found)
        alike = bool(max(found[:3]) <= arguments.within)
        if arguments.twice:
            run(program, scene, arguments, f"{folder}/{ranks}_again")
            others = same_bits.differences(f"{folder}/{ranks}", f"{folder}/{ranks}_again")
            alike = alike and not others
            text += f"; other bits the second time: {', '.join(others)}" if others else "; the same bits twice"
        yield ranks, alike, text


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("mpi_program")
    parser.add_argument("scenes", nargs="*", type=pathlib.Path)
    parser.add_argument("--ranks", nargs="+", type=int, default=[2, 3, 4, 8])
    parser.add_argument("--steps", type=int, default=20)
    parser.add_argument("--within", type=float, default=1e-9)
    parser.add_argument("--twice", action="store_true")
    arguments = parser.parse_intermixed_args()
    # More ranks than processors take turns; and containers may forbid a process to read another's memory.
    os.environ.update(OMPI_MCA_mpi_yield_when_idle="1", OMPI_MCA_btl_vader_single_copy_mechanism="none")
    alike = different = refused = 0
    for scene in arguments.scenes or same_bits.scenes():
        with tempfile.TemporaryDirectory() as folder:
            for ranks, is_alike, text in compare(scene, arguments, folder):
                alike += is_alike is True
                different += is_alike is False
                refused += is_alike is None
                print(f"{scene.name}, {ranks}: {'' if is_alike is not False else 'DIFFERS, '}{text}", flush=True)
    print(f"{alike} runs are alike, {different} differ or fail, {refused} scenes are refused")
    if alike + different == 0:
        return 2
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
