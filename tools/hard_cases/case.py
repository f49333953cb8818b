"""What a hard case is: scenes, and what a run of them must keep."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from methods import METHODS, Method
from runs import Run

Scene = dict[str, Any]
Runs = list[Run]


@dataclass(frozen=True)
class Check:
    """A number that may not exceed a limit."""

    name: str
    broken: str  # in a sentence, where it does: "tpic gained energy"
    measure: Callable[[Runs], float]
    limit: float
    unit: str  # of the number, in words
    garbage: bool = False  # a run that breaks it and yet says "done" has failed in silence


@dataclass(frozen=True)
class Case:
    """Scenes that run one after the other with the same method. The first one is checked by itself, too."""

    name: str
    section: str
    what: str
    scenes: list[Scene]
    checks: list[Check]
    notes: dict[str, Callable[[Runs], float]] = field(default_factory=dict)  # numbers without a limit
    methods: list[Method] = field(default_factory=lambda: METHODS)
    seconds: int = 60  # of the processor that a run may take
    long: bool = False
