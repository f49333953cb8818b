"""What the tests of the python module share. In the environment: PYTHONPATH, PROGRAM, WORK."""

import copy
import os
import shutil
import subprocess
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
WORK = Path(os.environ["WORK"])
PROGRAM = os.environ["PROGRAM"]

DROP = {
    "title": "Falling block",
    "dimension": 2,
    "grid": {"low": [0, 0], "high": [1, 1], "cells": [12, 12]},
    "fluid": {"density": 1000, "viscosity": 0.1},
    "body_force": [0, -9.81],
    "particles": [{"shape": {"box": {"low": [0, 0.1], "high": [0.5, 0.6]}}, "per_cell": 2, "velocity": ["y", 0.1]}],
    "time": {"end": 0.2, "step": 0.004},
    "output": {"every": 0.05},
}


def scene(**changes):
    """The falling block with other values of its keys."""
    return copy.deepcopy(DROP) | changes


def in_space():
    """The same in three dimensions, a few cells wide."""
    return scene(dimension=3, grid={"low": [0, 0, 0], "high": [1, 0.5, 1], "cells": [8, 4, 8]}, body_force=[0, 0, -9.81],
                 particles=[{"shape": {"box": {"low": [0, 0, 0.1], "high": [0.5, 0.5, 0.6]}}, "per_cell": 2,
                             "velocity": ["z", 0, 0.1]}])


def program(*arguments, cwd=None):
    """What the program does with these arguments."""
    return subprocess.run([PROGRAM, *map(str, arguments)], text=True, capture_output=True, check=False, cwd=cwd)


def folder(name):
    """An empty folder."""
    path = WORK / name
    shutil.rmtree(path, ignore_errors=True)
    path.mkdir(parents=True)
    return path


def state_of(run_folder):
    """The columns of a checkpoint that are kept as numbers, by name."""
    with h5py.File(run_folder / "checkpoint.h5") as file:
        return {name: data[()] for name, data in file["state"].items() if data.dtype == np.float64}


def as_stored(array):
    """An array as the checkpoint has it: a value's numbers one after the other as they lie in memory."""
    if array.ndim == 3:
        array = array.transpose(0, 2, 1)
    return np.ascontiguousarray(array).reshape(len(array), -1)
