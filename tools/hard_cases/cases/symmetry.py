"""A dam break mirrored, turned and with its axes exchanged: the same flow, until rounding has grown to a cell."""

from __future__ import annotations

import numpy as np

from case import Case, Check, Runs
from checks import ALWAYS
from compare import agree_until, differences
from scenes import Scene, dam_break, dam_break_in_space, turned


def case(name: str, what: str, of: Scene, axes: list[int], mirrored: list[bool]) -> Case:
    length = np.array([of["grid"]["high"][a] for a in axes])

    def place(x: np.ndarray) -> np.ndarray:
        return np.where(mirrored, length - x[:, axes], x[:, axes])

    def early_difference(runs: Runs) -> float:
        return float(np.max(differences(runs, place)[:3]))

    # Rounding, which grows: a tenth of the run is short of the first impact.
    check = Check("symmetry", "gave another result", early_difference, 1e-9, "cells")
    notes = {f"agree to {cells:.0e} cells until [s]": lambda runs, cells=cells: agree_until(runs, place, cells)
             for cells in (1e-6, 1e-3)}
    return Case(name, "symmetry", what, [of, turned(of, axes, mirrored)], [*ALWAYS, check], notes)


def cases() -> list[Case]:
    plane = dam_break(end=1.5)
    space = dam_break_in_space(8, end=0.4)
    return [
        case("mirrored", "left and right exchanged", plane, [0, 1], [True, False]),
        case("turned_by_90_degrees", "gravity along x", plane, [1, 0], [True, False]),
        case("upside_down", "turned by 180 degrees", plane, [0, 1], [True, True]),
        case("axes_exchanged", "x and y exchanged", plane, [1, 0], [False, False]),
        case("mirrored_in_space", "left and right exchanged", space, [0, 1, 2], [True, False, False]),
        case("axes_exchanged_in_space", "x, y, z become y, z, x", space, [1, 2, 0], [False, False, False]),
    ]
