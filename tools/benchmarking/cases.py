"""What is measured: cases, each of one or several runs that are compared with each other. Nothing is run here."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

# Equal order with its defaults, but TPIC of first order, with which the figures of others were measured; some of the
# scenes below name another method.
DEFAULTS = {
    "/discretization": {"scheme": "equal_order"},
    "/transfer": {"scheme": "tpic"},
    "/integrator": {"scheme": "midpoint"},
    "/quadrature": {"scheme": "mixed"},
    "/volume": {"scheme": "projection"},
    "/solver": {"scheme": "block"},
}
# The first is minamo's default.
BOTH = {"conforming": {"/discretization": {"scheme": "conforming"}}, "equal order": DEFAULTS}
NO_FRAMES = {"/output/every": 1e6}  # but the first and the last
DAM_BREAK = "paper/dam_break_tpic"
KERNELS = "kernels"  # the case that the program of the micro-benchmarks measures


@dataclass(frozen=True)
class Run:
    """A call of `minamo run`."""

    label: str
    scene: str  # of the folder scenes, without .json
    overrides: dict[str, Any]  # by JSON pointer
    threads: int = 1
    steps: int | None = None  # to the end of the scene if none
    compare: bool = False  # with interFoam, by tools/compare_interfoam.py

    def shortened(self, steps: int) -> Run:
        """The same for a quick look."""
        return replace(self, steps=min(steps, self.steps or steps), compare=False)


@dataclass(frozen=True)
class Case:
    """Runs that take turns: A B A B ..."""

    name: str
    section: str
    runs: list[Run] = field(default_factory=list)
    repeat_at_most: int | None = None  # long ones are run less often than the others


def dam_break(cells: int, per_cell: int, step: float, **more: Any) -> dict[str, Any]:
    """DAM_BREAK on cells x cells. `step` in s."""
    return DEFAULTS | {"/grid/cells": [cells, cells], "/particles/0/per_cell": per_cell, "/time/step": step} | more


def both(name: str, label: str, scene: str, overrides: dict[str, Any], repeat: int | None = None,
         section: str = "both", **more: Any) -> Case:
    """A run with either discretization, with TPIC."""
    runs = [Run(f"{label}, {discretization}", scene, method | {"/transfer": {"scheme": "tpic"}} | overrides, **more)
            for discretization, method in BOTH.items()]
    return Case(name, section, runs, repeat)


def both_cases() -> list[Case]:
    made = []
    for cells, ms, repeat in ((40, 2, None), (40, 8, None), (80, 1, 1), (80, 4, None), (160, 2, 1)):
        of_scene = {"/grid/cells": [cells, cells], "/particles/0/per_cell": 2, "/time/step": 1e-3 * ms,
                    "/output/every": 0.1}
        made.append(both(f"both_{cells}_{ms}ms", f"{cells} x {cells}, {ms} ms", "dam_break", of_scene, repeat,
                         compare=True))
    for threads in (1, 2):
        made.append(both(f"both_large_{threads}", f"large, {threads} thread{'s' * (threads > 1)}", "dam_break_large",
                         NO_FRAMES, threads=threads, steps=250))
    made.append(both("both_large_whole", "large, 2 threads, to 7 s", "dam_break_large", {}, 1, threads=2))
    return made


def size_cases() -> list[Case]:
    made = []
    for cells, steps in ((40, 100), (80, 100), (160, 60), (320, 40), (640, 40)):
        of_scene = {"/grid/cells": [cells, cells], "/particles/0/per_cell": 4, "/time/step": 0.08 / cells}
        made.append(both(f"size_{cells}", f"{cells} x {cells}, 4 x 4", "dam_break", of_scene | NO_FRAMES,
                         1 if cells == 640 else None, steps=steps, section="size"))
    return made


def space_cases() -> list[Case]:
    made = []
    for cells, threads, steps, repeat in ((32, 1, 10, None), (32, 2, 10, None), (68, 1, 10, 1), (68, 2, 10, 1),
                                          (108, 2, 3, 1)):
        of_scene = NO_FRAMES | {"/grid/cells": [cells, cells // 2, cells], "/time/step": 0.056 / cells}
        label = f"{cells} x {cells // 2} x {cells}, {threads} thread{'s' * (threads > 1)}"
        made.append(both(f"space_{cells}_{threads}", label, "dam_break_3d", of_scene, repeat, section="space",
                         threads=threads, steps=steps))
    return made


def solver_cases() -> list[Case]:
    made = []
    for cells, per_cell, steps in ((8, 2, 400), (40, 2, 250), (80, 4, 150), (160, 4, 50), (320, 4, 20)):
        scene = dam_break(cells, per_cell, 0.08 / cells) | NO_FRAMES
        runs = [Run(f"{cells} x {cells}, {per_cell} x {per_cell}, {solver}", DAM_BREAK,
                    scene | {"/solver": {"scheme": solver}}, steps=steps) for solver in ("block", "umfpack")]
        made.append(Case(f"solvers_{cells}", "solvers", runs))
    return made


def assembly_cases() -> list[Case]:
    runs = [Run(f"80 x 80, {n} x {n}", DAM_BREAK, dam_break(80, n, 1e-3) | NO_FRAMES, steps=100) for n in (2, 6)]
    return [Case("assembly_80", "assembly", runs)]


CASES = [*both_cases(), *size_cases(), *space_cases(), *solver_cases(), *assembly_cases(), Case(KERNELS, KERNELS)]
SECTIONS = list(dict.fromkeys(case.section for case in CASES))
