#!/usr/bin/env python3
"""Whether two builds of minamo compute the same bits, for changes of structure that must not change a result.

    tests/same_bits.py BEFORE AFTER [--steps 20] [SCENE]...

BEFORE and AFTER are programs; every scene of scenes/ by default. A scene is run by both for as many steps, and their
histories and the columns of their checkpoints are compared. Ends with 0 if all are the same, 1 if any differs, 2 if
nothing was compared.
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
    for path in sorted(pathlib.Path(folder).glob("checkpoint*.h5")):
        with h5py.File(path) as file:
            file.visititems(lambda name, item: found.update({f"{path.name}:{name}": (
                str(item.dtype), item.shape, item[()].tobytes() if item.dtype.hasobject is False else str(item[()]))})
                            if isinstance(item, h5py.Dataset) else None)
    return found


def differences(before, after):
    """Names of what differs between two folders of results."""
    names = []
    old, new = (pathlib.Path(folder) / "history.csv" for folder in (before, after))
    if not old.exists() or not new.exists():
        names += [] if old.exists() == new.exists() else ["history.csv"]
    elif old.read_bytes() != new.read_bytes():
        names.append("history.csv")
    old, new = columns(before), columns(after)
    return names + [name for name in sorted(old.keys() | new.keys()) if old.get(name) != new.get(name)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("before")
    parser.add_argument("after")
    parser.add_argument("scenes", nargs="*", type=pathlib.Path)
    parser.add_argument("--steps", type=int, default=20)
    arguments = parser.parse_intermixed_args()
    same = different = 0
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
        else:
            same += 1
    print(f"{same} scenes are the same, {different} differ")
    if same + different == 0:
        return 2
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
