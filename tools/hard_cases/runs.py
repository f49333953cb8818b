"""Runs scenes and reads what the runs leave behind."""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from methods import Method

ROOT = Path(__file__).resolve().parents[2]
DONE, BAD_INPUT, STOPPED = 0, 2, 3


class SuiteFailed(Exception):
    """The suite itself is wrong: a scene that the program does not take."""


@dataclass
class Frame:
    """Particles at an output time, in the order of their ids."""

    time: float
    id: np.ndarray
    mass: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    pressure: np.ndarray
    gradient: np.ndarray | None  # of the velocity, where the scheme carries it


@dataclass
class Run:
    """A run that has ended."""

    scene: dict[str, Any]
    exit: int | None  # none: it did not end in time
    message: str
    summary: dict[str, Any]
    history: dict[str, np.ndarray]
    frames: list[Frame] = field(repr=False)

    @property
    def ended(self) -> str:
        """How, in a word."""
        if self.exit is None:
            return "hung"
        return {DONE: "done", STOPPED: "stopped"}.get(self.exit, "crashed")

    @property
    def cells(self) -> np.ndarray:
        return np.array(self.scene["grid"]["cells"])

    @property
    def low(self) -> np.ndarray:
        return np.array(self.scene["grid"]["low"], float)

    @property
    def high(self) -> np.ndarray:
        return np.array(self.scene["grid"]["high"], float)

    @property
    def spacing(self) -> float:
        return float((self.high[0] - self.low[0]) / self.cells[0])

    @property
    def force(self) -> np.ndarray:
        return np.array(self.scene.get("body_force", [0] * len(self.low)), float)

    @property
    def mass(self) -> float:
        return self.summary["conservation"]["mass"]

    @property
    def masses(self) -> np.ndarray:
        """By id, which no particle of these scenes comes by later. [kg]"""
        return self.frames[0].mass

    @cached_property
    def energy(self) -> np.ndarray:
        """Kinetic and potential above that of all water in the corner that it falls to, a value per row. [J]"""
        potential = self.history["potential_energy"] + self.mass * float(
            np.maximum(self.force, 0) @ (self.high - self.low))
        return self.history["kinetic_energy"] + np.where(np.isnan(potential), 0, potential)

    @property
    def speed_scale(self) -> float:
        """Of a fluid whose energy, measured from the floor, is all motion; never less than the fastest particle, or than
        a body. [m/s]"""
        return max(float(np.sqrt(2 * max(0.0, self.energy[0]) / self.mass)), float(self.history["max_speed"][0]),
                   self.body_speed)

    @property
    def body_speed(self) -> float:
        """Fastest point of a body at any time, of one that turns at half the length of the box. [m/s]"""
        fastest = 0.0
        for body in self.scene.get("bodies", []):
            def length_of(what: str, name: str = body["name"]) -> np.ndarray:
                columns = [values for column, values in self.history.items()
                           if column == f"{name}_{what}" or column[:-1] == f"{name}_{what}_"]
                return np.sqrt(sum(values**2 for values in columns))

            reach = 0.5 * float(np.max(self.high - self.low))
            fastest = max(fastest, float(np.max(length_of("velocity") + reach * length_of("rotation"))))
        return fastest


def run(program: Path, scene: dict[str, Any], method: Method, folder: Path, seconds: int) -> Run:
    """A call of `minamo run`. The time is that of the processor: a machine with more to do is no reason to fail."""
    folder.mkdir(parents=True, exist_ok=True)
    scene = method.of(scene)
    # Runs are compared to the last digits.
    scene = scene | {"output": {"precision": "double"} | scene.get("output", {})}
    file = folder / "case.json"
    file.write_text(json.dumps(scene, indent=1))
    command = [str(program), "run", str(file), "--threads", "1", "--quiet", "--overwrite", "--out", str(folder)]
    done = subprocess.run(command, env=os.environ | {"OPENBLAS_NUM_THREADS": "1"}, text=True, cwd=ROOT,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1)))
    exit_code: int | None = done.returncode
    said = done.stdout.strip()
    if exit_code in (-signal.SIGXCPU, -signal.SIGKILL):
        exit_code, said = None, f"not at its end after {seconds} s"
    if exit_code == BAD_INPUT:
        raise SuiteFailed(f"{file}: {said}")
    summary = folder / "summary.json"
    return Run(scene, exit_code, said, json.loads(summary.read_text()) if summary.is_file() else {},
               history(folder / "history.csv"), frames(folder / "fields.h5"))


def history(file: Path) -> dict[str, np.ndarray]:
    """Columns. An empty field is nan; so is the potential energy where there is none."""
    lines = file.read_text().splitlines() if file.is_file() else []
    if len(lines) < 2:
        return {}
    names = lines[0].split(",")
    if len(lines[-1].split(",")) != len(names):  # cut off
        lines.pop()
    rows = np.loadtxt([",".join(field or "nan" for field in line.split(",")) for line in lines[1:]], delimiter=",", ndmin=2)
    return dict(zip(names, rows.T))


def frames(file: Path) -> list[Frame]:
    if not file.is_file():
        return []
    try:
        with h5py.File(file) as fields:
            groups = fields["particles"]
            return [frame(groups[name]) for name in sorted(groups, key=int)]
    except (OSError, KeyError):  # cut off by a crash
        return []


def frame(group: h5py.Group) -> Frame:
    ids = group["id"][:].ravel()
    order = np.argsort(ids)
    position = group["position"][:][order]
    dimension = position.shape[1]
    gradient = None
    if "velocity_gradient" in group:
        rows = group["velocity_gradient"][:][order]
        size = 3 if rows.shape[1] == 9 else dimension
        gradient = rows.reshape(len(order), size, size)[:, :dimension, :dimension]
    return Frame(float(group.attrs["time"]), ids[order], group["mass"][:][order], position,
                 group["velocity"][:][order][:, :dimension], group["pressure"][:].ravel()[order], gradient)
