"""A case with a method: runs its scenes and holds them against its checks."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from case import Case
from methods import Method
from runs import DONE, run

Judged = dict[str, Any]


def judge(case: Case, method: Method, program: Path, folder: Path) -> Judged:
    """What results.json holds of it."""
    runs = [run(program, scene, method, folder / f"{case.name}_{method.name}_{k}", case.seconds)
            for k, scene in enumerate(case.scenes)]
    judged: Judged = {
        "ended": [one.ended for one in runs],
        "said": [one.message.splitlines()[0] if one.message else "" for one in runs if one.exit != DONE],
        "time": [float(one.history["time"][-1]) if one.history else 0.0 for one in runs],
        "steps": sum(one.summary.get("steps", 0) for one in runs),
        "put_back": sum(one.summary.get("put_back", 0) for one in runs),
        "rejected": sum(one.summary.get("rejected_steps", 0) for one in runs),
        "wall_s": sum(one.summary.get("wall_s", 0.0) for one in runs),
        "values": {check.name: number(check.measure(runs)) for check in case.checks},
        "notes": {name: number(note(runs)) for name, note in case.notes.items()},
    }
    judged["broken"] = [check.name for check in case.checks if not judged["values"][check.name] <= check.limit]
    garbage = any(check.garbage and check.name in judged["broken"] for check in case.checks)
    judged["silent"] = garbage and all(ended == "done" for ended in judged["ended"])
    return judged


def number(value: float) -> float:
    """What JSON has a word for."""
    return value if math.isfinite(value) else 1e308
