"""Boxes that are full, nearly empty or as small as they can be, and boxes in which nothing happens."""

from __future__ import annotations

from case import Case
from checks import ALWAYS, ENERGY, REST, VOLUME
from scenes import ball, box, dam_break, down, scene

H = 1 / 16


def cases() -> list[Case]:
    checks = [*ALWAYS, ENERGY, VOLUME]

    def case(name: str, what: str, of: dict, *more: object) -> Case:
        return Case(name, "boxes", what, [of], [*checks, *more])

    full = [box([0, 0], [1, 1])]
    vortex = ["sin(pi*x)*cos(pi*y)", "-cos(pi*x)*sin(pi*y)"]
    return [
        case("full_at_rest", "a full box without force", scene([16, 16], H, full, 0.4, 4e-3), REST),
        case("full_under_gravity", "a full box under gravity", scene([16, 16], H, full, 0.4, 4e-3,
                                                                     body_force=down(2))),
        case("full_with_a_vortex", "a full box with a vortex",
             scene([16, 16], H, [box([0, 0], [1, 1], 2, vortex)], 1.0, 8e-3)),
        case("full_and_random", "a full box of particles at random places, with a vortex",
             scene([16, 16], H, [box([0, 0], [1, 1], 2, vortex, arrangement="jittered", seed=7)], 1.0, 8e-3)),
        case("drop_at_rest", "a drop without force", scene([16, 16], H, [ball([0.5, 0.5], 0.25)], 0.4, 4e-3), REST),
        case("one_wet_cell", "one cell of water in the corner of a box, under gravity",
             scene([16, 16], H, [box([0, 0], [H, H])], 0.8, 4e-3, body_force=down(2))),
        case("one_wet_cell_falling", "one cell of water that falls to the floor",
             scene([16, 16], H, [box([0.5, 0.5], [0.5 + H, 0.5 + H])], 0.8, 4e-3, body_force=down(2))),
        case("smallest_box", "a dam break in a box of 3 x 3 cells",
             scene([3, 3], 1 / 4, [box([0, 0], [0.25, 0.5])], 1.0, 4e-3, body_force=down(2))),
        case("smallest_full_box", "a full box of 3 x 3 cells under gravity",
             scene([3, 3], 1 / 4, [box([0, 0], [0.75, 0.75])], 0.4, 4e-3, body_force=down(2))),
        case("narrow_shaft", "water that falls down a shaft of three cells",
             scene([3, 32], 1 / 16, [box([0, 1], [0.1875, 1.75])], 0.8, 4e-3, body_force=down(2))),
        case("far_from_the_origin", "a dam break in a box at 1e6 m",
             dam_break(grid={"low": [2.0**20, 2.0**20], "high": [2.0**20 + 1, 2.0**20 + 1], "cells": [16, 16]},
                       particles=[box([2.0**20, 2.0**20], [2.0**20 + 0.25, 2.0**20 + 0.5])])),
        case("full_in_space", "a full box in 3-D under gravity",
             scene([6, 6, 6], 1 / 6, [box([0, 0, 0], [1, 1, 1])], 0.1, 4e-3, body_force=down(3))),
        case("one_wet_cell_in_space", "one cell of water in the corner of a box, under gravity",
             scene([8, 8, 8], 1 / 8, [box([0, 0, 0], [1 / 8, 1 / 8, 1 / 8])], 0.4, 4e-3, body_force=down(3))),
    ]
