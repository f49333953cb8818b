"""Few, many, random and uneven particles."""

from __future__ import annotations

from case import Case
from checks import ALWAYS, ENERGY, VOLUME
from scenes import ball, box, dam_break, down, scene


def cases() -> list[Case]:
    checks = [*ALWAYS, ENERGY, VOLUME]

    def case(name: str, what: str, of: dict) -> Case:
        return Case(name, "seeds", what, [of], checks)

    column = [0.0, 0.0], [0.25, 0.5]
    made = [case(f"per_cell_{n * n}", f"dam break, {n * n} per cell", dam_break(per_cell=n, end=end))
            for n, end in ((1, 1.0), (2, 1.0), (6, 0.8), (10, 0.4))]
    for n in (1, 2, 4):
        made.append(case(f"cloud_{n * n}", f"dam break, {n * n} per cell at random places",
                         dam_break(particles=[box(*column, n, arrangement="jittered", seed=7)])))
    return made + [
        case("uneven_halves", "dam break, 1 and 64 particles per cell side by side",
             dam_break(particles=[box([0, 0], [0.125, 0.5], 1), box([0.125, 0], [0.25, 0.5], 8)], end=1.0)),
        case("uneven_within_cells", "dam break, a border of 4 and 256 particles per cell through the middle of cells",
             dam_break(particles=[box([0, 0], [0.25, 0.21875], 2), box([0, 0.21875], [0.25, 0.5], 16)], end=0.6)),
        case("coarse_on_fine", "a pool of 64 per cell, a drop of 1 per cell that falls into it",
             scene([16, 16], 1 / 16, [box([0, 0], [1, 0.25], 8), ball([0.5, 0.625], 0.125, 1)], 0.8, 4e-3,
                   body_force=down(2))),
        case("fine_on_coarse", "a pool of 1 per cell, a drop of 64 per cell that falls into it",
             scene([16, 16], 1 / 16, [box([0, 0], [1, 0.25], 1), ball([0.5, 0.625], 0.125, 8)], 0.8, 4e-3,
                   body_force=down(2))),
        case("cloud_in_space", "dam break in 3-D, 8 per cell at random places",
             scene([12, 6, 12], 1 / 12, [box([0, 0, 0], [0.25, 0.25, 0.5], 2, arrangement="jittered", seed=7)], 0.5,
                   8e-3, body_force=down(3))),
    ]
