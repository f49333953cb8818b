"""A case with a method: runs its scenes and holds them against its checks."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from case import Case
from methods import Method
from runs import DONE, run

# Of the program, at the end of a run, with the checks that it warns of.
WARNINGS = {"energy rose by": ("energy", "balance", "speed", "pressure"), "pressure turned over": ("speed", "pressure")}
NOTHING = 1e308  # stands for a number that is not finite


@dataclass
class Judged:
    """What became of it."""

    ended: list[str]  # a word per run
    steps: int = 0
    rejected: int = 0  # steps taken back and repeated
    said: str = ""  # by the first run that did not come to its end
    values: dict[str, float] = field(default_factory=dict)  # by check
    notes: dict[str, float] = field(default_factory=dict)
    broken: list[str] = field(default_factory=list)  # checks
    silent: bool = False

    @property
    def kept_all(self) -> bool:
        return not self.broken and set(self.ended) == {"done"}


def judge(case: Case, method: Method, program: Path, folder: Path) -> Judged:
    runs = [run(program, scene, method, folder / f"{case.name}_{method.name}_{k}", case.seconds)
            for k, scene in enumerate(case.scenes)]
    values = {check.name: number(check.measure(runs)) for check in case.checks}
    broken = [check for check in case.checks if not values[check.name] <= check.limit]
    judged = Judged([one.ended for one in runs],
                    steps=sum(one.summary.get("steps", 0) for one in runs),
                    rejected=sum(one.summary.get("rejected_steps", 0) for one in runs),
                    said=next((one.message.split("\n")[0] for one in runs if one.exit != DONE), ""),
                    values=values,
                    notes={name: number(note(runs)) for name, note in case.notes.items()},
                    broken=[check.name for check in broken])
    warned_of = {name for text, names in WARNINGS.items() for name in names if any(text in one.message for one in runs)}
    judged.silent = (any(check.garbage and check.name not in warned_of for check in broken)
                     and set(judged.ended) == {"done"})
    return judged


def number(value: float) -> float:
    """Three digits, and what JSON has a word for."""
    return float(f"{value:.3g}") if math.isfinite(value) else NOTHING


def packed(judged: Judged) -> dict[str, Any]:
    """For results.json: what is neither empty nor zero."""
    full = asdict(judged) | {"values": {name: value for name, value in judged.values.items() if value != 0}}
    return {key: value for key, value in full.items() if value}


def unpacked(entry: dict[str, Any]) -> Judged:
    return Judged(**entry)
