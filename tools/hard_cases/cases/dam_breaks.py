"""The dam break of the paper, 40 x 40 cells, with steps that are too long for it."""

from __future__ import annotations

from case import Case
from checks import ALWAYS, ENERGY, VOLUME
from scenes import Scene, box, dam_break_in_space, scene, with_cfl

WIDTH = 0.146


def paper(end: float, step: float) -> Scene:
    return scene([40, 40], 4 * WIDTH / 40, [box([0, 0], [WIDTH, 2 * WIDTH])], end, step, body_force=[0.0, -9.81])


def cases() -> list[Case]:
    checks = [*ALWAYS, ENERGY, VOLUME]
    made = [Case("dam_break_10_ms", "dam_breaks", "steps of 10 ms, ten times the paper's", [paper(1.0, 1e-2)], checks)]
    for cfl in (1, 2, 4):
        made.append(Case(f"dam_break_cfl_{cfl}", "dam_breaks", f"CFL number {cfl}", [with_cfl(paper(1.0, 1e-2), cfl)],
                         checks))
    for cfl in (1, 4):
        made.append(Case(f"dam_break_in_space_cfl_{cfl}", "dam_breaks", f"in 3-D, 12 x 6 x 12 cells, CFL number {cfl}",
                         [with_cfl(dam_break_in_space(), cfl)], checks))
    return made
