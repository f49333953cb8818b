#!/usr/bin/env python3
"""Whether two builds of minamo compute the same bits, for changes of structure that must not change a result.

    tests/same_bits.py BEFORE AFTER [--steps 20] [SCENE]...

BEFORE and AFTER are programs; every scene of scenes/ by default. A scene is run by both for as many steps, and their
histories and the columns of their checkpoints are compared. Ends with 0 if all are the same, 1 if any differs or fails
with both, 2 if nothing was compared.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import h5py

SCENES = pathlib.Path(__file__).resolve().parent.parent / "scenes"


def scenes():
    """All files below scenes/ that are a scene, and no study or schema."""
    for path in sorted(SCENES.rglob("*.json")):
        if {"grid", "time"} <= set(json.loads(path.read_text(encoding="utf8"))):
            yield path


def run(program, scene, steps, out):
    """The exit code, and what the run says where it fails."""
    done = subprocess.run([program, "run", scene, "--steps", str(steps), "--out", out, "--quiet"],
                          capture_output=True, text=True, check=False)
    return done.returncode, done.stderr if done.returncode else ""


def columns(folder):
    """All data sets of the checkpoint by name, as bytes with their type and shape."""
    found = {}

    def add(name, item):
        if isinstance(item, h5py.Dataset):
            value = str(item[()]) if item.dtype.hasobject else item[()].tobytes()
            found[name] = (str(item.dtype), item.shape, value)

    path = pathlib.Path(folder) / "checkpoint.h5"
    if path.exists():
        with h5py.File(path) as file:
            file.visititems(add)
    return found


def differences(before, after):
    """Names of what differs between two folders of results."""
    paths = [pathlib.Path(folder) / "history.csv" for folder in (before, after)]
    old, new = (path.read_bytes() if path.exists() else None for path in paths)
    names = [] if old == new else ["history.csv"]
    old, new = columns(before), columns(after)
    return names + [name for name in sorted(old.keys() | new.keys()) if old.get(name) != new.get(name)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("before")
    parser.add_argument("after")
    parser.add_argument("scenes", nargs="*", type=pathlib.Path)
    parser.add_argument("--steps", type=int, default=20)
    arguments = parser.parse_intermixed_args()
    same = different = failed = 0
    for scene in arguments.scenes or scenes():
        with tempfile.TemporaryDirectory() as folder:
            results = [run(program, scene, arguments.steps, f"{folder}/{name}")
                       for name, program in (("before", arguments.before), ("after", arguments.after))]
            names = differences(f"{folder}/before", f"{folder}/after")
            if results[0] != results[1]:
                names.insert(0, f"exit code and words: {results[0]} and {results[1]}")
        if names:
            different += 1
            print(f"{scene}: differs in {', '.join(names)}", flush=True)
        elif results[0][0] != 0:
            failed += 1
            print(f"{scene}: fails with both: {results[0][1].strip()}", flush=True)
        else:
            same += 1
    print(f"{same} scenes are the same, {different} differ, {failed} fail")
    if same + different + failed == 0:
        return 2
    return 1 if different or failed else 0


if __name__ == "__main__":
    sys.exit(main())
