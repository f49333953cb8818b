"""The same flow in other units of length, time and mass: numbers without a unit must not change."""

from __future__ import annotations

import numpy as np

from case import Case, Check, Runs
from checks import ALWAYS
from compare import agree_until, differences
from scenes import Scene, dam_break, dam_break_in_space, in_other_units


def case(name: str, what: str, of: Scene, length: float, time: float, density: float = 1.0) -> Case:
    def place(x: np.ndarray) -> np.ndarray:
        return x * length

    def difference(runs: Runs) -> float:
        return float(np.max(differences(runs, place)))

    def early_difference(runs: Runs) -> float:
        return float(np.max(differences(runs, place)[:3]))

    powers = all(np.frexp(unit)[0] == 0.5 for unit in (length, time, density))
    # Units that are powers of two change exponents alone: no rounding, no bit. Others change roundings of 1e-16, which
    # grow: a tenth of the run is short of the first impact.
    check = (Check("units", "gave another result in other units", difference, 0, "cells") if powers else
             Check("units", "gave another result in other units", early_difference, 1e-9, "cells"))
    notes = {"agree to 1e-3 cells until [s]": lambda runs: agree_until(runs, place, 1e-3)}
    return Case(name, "units", what, [of, in_other_units(of, length, time, density)], [*ALWAYS, check], notes)


def cases() -> list[Case]:
    water = dam_break(end=0.5, step=1 / 256)
    oil = dam_break(end=0.5, step=1 / 256, fluid={"density": 1000.0, "viscosity": 10.0})
    space = dam_break_in_space(8, end=0.125, step=1 / 128)
    micro, macro, brief, slow = 2.0**-20, 2.0**14, 2.0**-30, 2.0**20
    return [
        case("length_2_to_-20", "lengths of 1e-6 m", water, micro, 1.0),
        case("length_2_to_14", "lengths of 1.6e4 m", water, macro, 1.0),
        case("time_2_to_-30", "times of 1e-9 s", water, 1.0, brief),
        case("time_2_to_20", "times of 1e6 s", water, 1.0, slow),
        case("density_2_to_-20", "densities of 1e-3 kg/m^3", water, 1.0, 1.0, 2.0**-20),
        case("all_small", "1e-6 m, 1e-9 s, 1e-3 kg/m^3", water, micro, brief, 2.0**-20),
        case("all_large", "1.6e4 m, 1e6 s, 1e6 kg/m^3", water, macro, slow, 2.0**10),
        case("oil_small", "a viscous liquid, 1e-6 m, 1e-9 s", oil, micro, brief, 2.0**-10),
        case("oil_large", "a viscous liquid, 1.6e4 m, 1e6 s", oil, macro, slow, 2.0**10),
        case("in_space_small", "in 3-D, 1e-6 m, 1e-9 s", space, micro, brief),
        case("millionth", "a factor of 1e-6 in length, 1e-9 in time", water, 1e-6, 1e-9),
        case("ten_thousand", "a factor of 1e4 in length, 1e6 in time", water, 1e4, 1e6),
    ]
