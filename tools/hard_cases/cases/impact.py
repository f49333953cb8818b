"""Drops, sheets and jets that meet each other and walls."""

from __future__ import annotations

import numpy as np

from case import Case, Check, Runs
from checks import ALWAYS, ENERGY, MOMENTUM, VOLUME
from compare import distances
from scenes import ball, box, down, scene, with_cfl

H = 1 / 16


def mirror_error(runs: Runs) -> float:
    """Distance from the mirror image of the same run, until a tenth of its time, in cells."""
    run = runs[0]

    def mirrored(x: np.ndarray) -> np.ndarray:
        return x * np.array([-1, *[1] * (x.shape[1] - 1)]) + np.array([run.high[0], *[0] * (x.shape[1] - 1)])

    away = distances(run, run, mirrored, run.spacing)
    return float(np.max(away[:max(2, len(away) // 10)]))


# Rounding of 1e-15 of the box, which an impact lets grow.
SYMMETRY = Check("symmetry", "lost its mirror symmetry", mirror_error, 1e-9, "cells")


def case(name: str, what: str, of: dict, *more: Check) -> Case:
    return Case(name, "impact", what, [of], [*ALWAYS, ENERGY, VOLUME, *more])


def cases() -> list[Case]:
    drops = scene([32, 32], H, [ball([0.625, 1.0], 0.25, 2, [2.0, 0.0]), ball([1.375, 1.0], 0.25, 2, [-2.0, 0.0])],
                  0.75, 0.01)
    in_space = scene([16, 12, 12], 1 / 8, [ball([0.625, 0.75, 0.75], 0.25, 2, [2.0, 0.0, 0.0]),
                                           ball([1.375, 0.75, 0.75], 0.25, 2, [-2.0, 0.0, 0.0])], 0.4, 0.02)
    oblique = scene([32, 32], H, [ball([0.625, 0.9375], 0.25, 2, [2.0, 0.0]),
                                  ball([1.375, 1.0625], 0.25, 2, [-2.0, 0.0])], 0.75, 0.01)
    return [
        case("drops_cfl_2", "two drops that collide head on, CFL number 2", with_cfl(drops, 2), SYMMETRY),
        case("drops_oblique_cfl_2", "two drops that graze each other, CFL number 2", with_cfl(oblique, 2)),
        case("drops_fixed_step", "two drops that collide head on, CFL number 0.3, until they meet walls", drops,
             SYMMETRY),
        case("drops_in_space_cfl_2", "two drops that collide head on, CFL number 2", with_cfl(in_space, 2), SYMMETRY),
        case("drop_into_pool", "a drop that falls into a pool, CFL number 1",
             with_cfl(scene([32, 32], H, [box([0, 0], [2, 0.5]), ball([1.0, 1.25], 0.25, 2, [0.0, -3.0])], 1.0, 0.01,
                            body_force=down(2)), 1)),
        case("sheet_falling", "a sheet one particle thick falls flat on the floor",
             scene([32, 16], H, [box([0.25, 0.5], [1.75, 0.53125])], 0.8, 0.004, body_force=down(2))),
        case("sheet_upright", "a sheet one particle thick, standing, collapses",
             scene([32, 16], H, [box([1.0, 0], [1.03125, 0.75])], 0.8, 0.004, body_force=down(2))),
        Case("sheet_turning", "impact", "a sheet one particle thick that turns about its middle, free",
             [scene([32, 32], H, [box([0.5, 1.0], [1.5, 1.03125], 2, ["-(y-1.015625)*4", "(x-1)*4"])], 0.4, 0.01)],
             [*ALWAYS, ENERGY, MOMENTUM]),
        case("jet_into_corner", "a jet of 12 cells that hits a corner at 45 degrees and 5 m/s",
             scene([32, 32], H, [{"shape": {"where": "abs(x-y) < 0.25 && x+y > 0.75 && x+y < 2"}, "per_cell": 2,
                                  "velocity": [-3.5, -3.5]}], 0.6, 0.004)),
        case("jet_into_corner_cfl_2", "the same, CFL number 2",
             with_cfl(scene([32, 32], H, [{"shape": {"where": "abs(x-y) < 0.25 && x+y > 0.75 && x+y < 2"},
                                           "per_cell": 2, "velocity": [-3.5, -3.5]}], 0.6, 0.004), 2)),
        case("jet_into_corner_in_space", "a jet that hits a corner of three walls",
             scene([8, 8, 8], 1 / 8, [{"shape": {
                 "where": "abs(x-y) < 0.25 && abs(y-z) < 0.25 && abs(x-z) < 0.25 && x+y+z > 0.75 && x+y+z < 1.75"},
                 "per_cell": 2, "velocity": [-3.0, -3.0, -3.0]}], 0.4, 0.01)),
    ]
