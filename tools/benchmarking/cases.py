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


def both(name: str, label: str, scene: str, overrides: dict[str, Any], repeat: int | None = None, **more: Any) -> Case:
    """A run with either discretization, with TPIC."""
    runs = [Run(f"{label}, {discretization}", scene, method | {"/transfer": {"scheme": "tpic"}} | overrides, **more)
            for discretization, method in BOTH.items()]
    return Case(name, "both", runs, repeat)


def both_cases() -> list[Case]:
    made = []
    for cells, ms, repeat in ((40, 2, None), (40, 8, None), (80, 1, 1), (80, 4, None)):
        of_scene = {"/grid/cells": [cells, cells], "/particles/0/per_cell": 2, "/time/step": 1e-3 * ms,
                    "/output/every": 0.1}
        made.append(both(f"both_{cells}_{ms}ms", f"{cells} x {cells}, {ms} ms", "dam_break", of_scene, repeat,
                         compare=True))
    for cells, ms, steps in ((160, 0.5, 60), (320, 0.25, 20)):
        of_scene = {"/grid/cells": [cells, cells], "/particles/0/per_cell": 4, "/time/step": 1e-3 * ms}
        made.append(both(f"both_{cells}", f"{cells} x {cells}, {ms} ms, 4 x 4", "dam_break", of_scene | NO_FRAMES,
                         steps=steps))
    for threads in (1, 2):
        made.append(both(f"both_large_{threads}", f"large, {threads} thread{'s' * (threads > 1)}", "dam_break_large",
                         NO_FRAMES, threads=threads, steps=250))
    for cells, steps, repeat in ((32, 10, None), (68, 5, 1)):
        of_scene = NO_FRAMES | {"/grid/cells": [cells, cells // 2, cells], "/time/step": 0.056 / cells}
        made.append(both(f"both_space_{cells}", f"{cells} x {cells // 2} x {cells}", "dam_break_3d", of_scene, repeat,
                         threads=2, steps=steps))
    return made


def paper_cases() -> list[Case]:
    made = []
    for cells, ms in ((40, 2), (40, 8), (80, 1), (80, 4)):
        run = Run(f"{cells} x {cells}, {ms} ms", DAM_BREAK, dam_break(cells, 2, 1e-3 * ms), compare=True)
        made.append(Case(f"dam_break_{cells}_{ms}ms", "dam_break", [run]))
    return made


def thread_cases() -> list[Case]:
    runs = [Run(f"large, {n} thread{'s' * (n > 1)}", "dam_break_large", DEFAULTS | NO_FRAMES, threads=n, steps=250)
            for n in (1, 2)]
    whole = Run("large, 2 threads, to 7 s", "dam_break_large", DEFAULTS, threads=2)
    return [Case("threads_250_steps", "threads", runs), Case("threads_whole", "threads", [whole])]


def solver_cases() -> list[Case]:
    made = []
    for cells, per_cell, steps in ((8, 2, 400), (40, 2, 250), (80, 4, 150), (160, 4, 50), (320, 4, 20)):
        scene = dam_break(cells, per_cell, 0.08 / cells) | NO_FRAMES
        runs = [Run(f"{cells} x {cells}, {per_cell} x {per_cell}, {solver}", DAM_BREAK,
                    scene | {"/solver": {"scheme": solver}}, steps=steps) for solver in ("block", "umfpack")]
        made.append(Case(f"solvers_{cells}", "solvers", runs))
    return made


def size_cases() -> list[Case]:
    return [Case(f"size_{cells}", "size",
                 [Run(f"{cells} x {cells}, 4 x 4", DAM_BREAK, dam_break(cells, 4, 0.08 / cells) | NO_FRAMES,
                      steps=steps)])
            for cells, steps in ((40, 100), (80, 100), (160, 60), (320, 40), (640, 40))]


def assembly_cases() -> list[Case]:
    runs = [Run(f"80 x 80, {n} x {n}", DAM_BREAK, dam_break(80, n, 1e-3) | NO_FRAMES, steps=100) for n in (2, 6)]
    return [Case("assembly_80", "assembly", runs)]


def space_cases() -> list[Case]:
    made = []
    for cells, steps, repeat in ((32, 10, None), (68, 10, 1), (108, 3, 1)):
        scene = DEFAULTS | NO_FRAMES | {"/grid/cells": [cells, cells // 2, cells], "/time/step": 0.056 / cells}
        run = Run(f"{cells} x {cells // 2} x {cells}", "dam_break_3d", scene, threads=2, steps=steps)
        made.append(Case(f"space_{cells}", "space", [run], repeat))
    return made


CASES = [*both_cases(), *paper_cases(), *thread_cases(), *solver_cases(), *size_cases(), *assembly_cases(),
         *space_cases(), Case(KERNELS, KERNELS)]
SECTIONS = list(dict.fromkeys(case.section for case in CASES))
