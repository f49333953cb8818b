"""Whether the transfer scheme of tools/example_scheme is what it says it is, in 2-D and in 3-D.

  example_scheme_test.py PROGRAM SCENE FOLDER
"""

from __future__ import annotations

import csv
import json
import subprocess
import sys
import unittest
from math import dist, hypot
from pathlib import Path
from typing import Any

PROGRAM, SCENE, FOLDER = sys.argv[1:4]

Scene = dict[str, Any]


def in_space(scene: Scene) -> Scene:
    """A scene of the plane with a third direction, as thick as wide, on half as many cells."""
    space = json.loads(json.dumps(scene))
    space["dimension"] = 3
    for key in ("low", "high", "cells"):
        space["grid"][key].append(space["grid"][key][0])
    space["grid"]["cells"] = [n // 2 for n in space["grid"]["cells"]]
    for region in space["particles"]:
        for corner in region["shape"]["box"].values():
            corner.append(corner[0])
        region["velocity"].append(0)
    space.get("body_force", []).append(0)
    return space


def spinning_square() -> Scene:
    return json.loads(Path(SCENE).read_text())


def falling_column() -> Scene:
    """From rest: particles that start with a velocity gradient start with all of it, whatever the scheme keeps."""
    return {"dimension": 2, "grid": {"low": [0, 0], "high": [0.8, 0.8], "cells": [16, 16]},
            "fluid": {"density": 1000, "viscosity": 1}, "body_force": [0, -9.81],
            "particles": [{"shape": {"box": {"low": [0, 0], "high": [0.2, 0.4]}}, "velocity": [0, 0]}],
            "time": {"end": 1, "step": 4e-3}}


class Run:
    """A run of some steps with a transfer scheme."""

    def __init__(self, scene: Scene, steps: int = 20, **transfer: Any):
        folder = Path(FOLDER) / "run"
        file = folder.with_suffix(".json")  # next to the results, among which there is a scene.json
        file.write_text(json.dumps({**scene, "transfer": transfer}))
        subprocess.run([PROGRAM, "run", file, "--out", folder, "--steps", str(steps), "--quiet", "--overwrite"], check=True)
        self.conserved = json.loads((folder / "summary.json").read_text())["conservation"]
        with open(folder / "history.csv", newline="") as history:
            self.kinetic_energy = [row["kinetic_energy"] for row in csv.DictReader(history)]

    def angular_momentum_kept(self) -> float:
        """Share of what there was at the start; it is all about the third axis."""
        return self.conserved["angular_momentum"][-1] / self.conserved["initial"]["angular_momentum"][-1]


class Rpic(unittest.TestCase):
    def both(self, scene: Scene) -> list[Scene]:
        """In 2-D and in 3-D, on nodes and on faces."""
        faces = [{**of, "discretization": {"scheme": "conforming"}, "fluid": {**of["fluid"], "viscosity": 0}}
                 for of in (scene, in_space(scene))]
        return [scene, in_space(scene), *faces]

    def test_momentum_is_conserved(self) -> None:
        # With masses of particles throughout: those of a full grid cost a body in flight 3e-6 of its momentum.
        for scene in self.both(spinning_square() | {"quadrature": {"scheme": "particles"}}):
            run = Run(scene, scheme="rpic", strain=0.3)
            before, after = run.conserved["initial"]["momentum"], run.conserved["momentum"]
            # Nodes too light for an equation (E15) take 3e-7 along, with every scheme.
            self.assertLess(dist(before, after), 1e-6 * hypot(*before))

    def test_nothing_kept_is_pic_to_the_last_digit(self) -> None:
        for scene in self.both(falling_column()):
            for integrator in ("midpoint", "newmark"):
                scene["integrator"] = {"scheme": integrator}
                rpic = Run(scene, scheme="rpic", rotation=0, strain=0, inertia="lumped")
                self.assertEqual(rpic.kinetic_energy, Run(scene, scheme="pic").kinetic_energy)
                self.assertNotEqual(rpic.kinetic_energy, Run(scene, scheme="rpic", inertia="lumped").kinetic_energy)

    def test_all_kept_is_tpic(self) -> None:
        for scene in self.both(spinning_square()):
            scene["solver"] = {"scheme": "umfpack"}
            rpic = Run(scene, steps=5, scheme="rpic", rotation=1, strain=1)
            tpic = Run(scene, steps=5, scheme="tpic", spin="gradient")
            # Other sums of the same numbers: roundings, which the direct solver leaves small.
            for one, other in zip(rpic.kinetic_energy, tpic.kinetic_energy, strict=True):
                self.assertAlmostEqual(float(one), float(other), delta=1e-12 * float(other))

    def test_rotation_is_kept_where_pic_loses_it(self) -> None:
        for scene in self.both(spinning_square()):
            lost = {scheme: 1 - Run(scene, scheme=scheme).angular_momentum_kept() for scheme in ("pic", "rpic")}
            self.assertLess(abs(lost["rpic"]), 0.1 * lost["pic"])

    def test_the_program_knows_the_scheme_and_its_options(self) -> None:
        listed = subprocess.run([PROGRAM, "list", "schemes"], check=True, capture_output=True, text=True).stdout
        self.assertRegex(listed, r"(?m)^rpic +particles take over")
        file = Path(FOLDER) / "wrong.json"
        for transfer, closest in (({"scheme": "rpik"}, '"rpic"'), ({"scheme": "rpic", "strian": 0.1}, '"strain"')):
            file.write_text(json.dumps({**spinning_square(), "transfer": transfer}))
            check = subprocess.run([PROGRAM, "check", file], capture_output=True, text=True)
            self.assertEqual(check.returncode, 2)
            self.assertIn(f"closest   {closest}", check.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
