"""Runs of scenes that pictures need: those that are there, and those that must be made."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from collections.abc import Mapping
from functools import reduce
from operator import getitem
from pathlib import Path
from typing import Any

from reporting.runs import NoResults, Run

ROOT = Path(__file__).resolve().parents[2]

Settings = tuple[tuple[str, Any], ...]  # JSON pointers into a scene, and the values there


def setting_arguments(settings: Settings) -> list[str]:
    """`--set POINTER=VALUE` ..., as `minamo run` takes them."""
    return [word for pointer, value in settings for word in ("--set", f"{pointer}={json.dumps(value)}")]


def read_scene(scene: Path) -> dict[str, Any]:
    if not scene.is_file():
        raise NoResults(f"{scene}: no such scene")
    return json.loads(scene.read_text())


def run_of(scene: Path, folder: Path, settings: Settings = ()) -> Run:
    """The run of a scene, with values set by JSON pointers."""
    there = _is_there(_with(read_scene(scene), settings), folder)
    if there is None or not there.summary.get("complete", False):
        program = os.environ.get("MINAMO")
        command = [program, "run"] if program else [str(ROOT / "tools/run")]
        # What was begun and is this very scene goes on; what else is unfinished there minamo does not replace.
        more = ["--resume"] if there and (folder / "checkpoint.h5").is_file() else []
        more += setting_arguments(settings)
        status = subprocess.run([*command, str(scene), "--out", str(folder), *more], check=False).returncode
        if status != 0:
            sys.exit(status)  # minamo has said why
    return Run(folder)


def _is_there(scene: dict[str, Any], folder: Path) -> Run | None:
    """The run of this very scene in the folder, finished or not, if there is one."""
    if not (folder / "scene.json").is_file():
        return None
    run = Run(folder)
    return run if _contains(run.scene, scene, run.scene.get("constants", {})) else None


def _with(scene: dict[str, Any], settings: Settings) -> dict[str, Any]:
    """The scene with other values at some JSON pointers."""
    for pointer, value in settings:
        *path, last = (int(key) if key.isdigit() else key for key in pointer.split("/")[1:])
        reduce(getitem, path, scene)[last] = value
    return scene


def _contains(whole: Any, part: Any, constants: Mapping[str, float]) -> bool:
    """The scene as it ran has all that the file says, values for its constant expressions, and the defaults."""
    if isinstance(part, dict):
        return isinstance(whole, dict) and all(key in whole and _contains(whole[key], part[key], constants)
                                               for key in part)
    if isinstance(part, list):
        return (isinstance(whole, list) and len(whole) == len(part)
                and all(_contains(*pair, constants) for pair in zip(whole, part)))
    if isinstance(part, str) and isinstance(whole, (int, float)):
        return math.isclose(whole, _value(part, constants), rel_tol=1e-12)
    return whole == part


def _value(expression: str, constants: Mapping[str, float]) -> float:
    """Of an expression in constants; none is a nan, which equals nothing."""
    try:
        return float(eval(expression.replace("^", "**"), {"__builtins__": {}}, vars(math) | dict(constants)))
    except (ArithmeticError, NameError, SyntaxError, TypeError, ValueError):
        return math.nan
