"""Liquids from inviscid to stiff, from a gas to a metal and far beyond."""

from __future__ import annotations

from case import Case
from checks import ALWAYS, ENERGY, VOLUME
from scenes import dam_break, dam_break_in_space


def liquid(density: float, nu: float) -> dict[str, float]:
    return {"density": density, "viscosity": density * nu}


def cases() -> list[Case]:
    checks = [*ALWAYS, ENERGY, VOLUME]
    made = [Case("inviscid", "liquids", "dam break, viscosity 0", [dam_break(fluid=liquid(1000, 0))], checks)]
    for nu in (1e-6, 1e-4, 1e-2, 1.0, 1e2, 1e3):
        made.append(Case(f"nu_{nu:.0e}", "liquids", f"dam break, kinematic viscosity {nu:g} m^2/s",
                         [dam_break(fluid=liquid(1000, nu))], checks))
    for density in (1e-3, 1.0, 1e5):
        made.append(Case(f"density_{density:.0e}", "liquids", f"dam break, density {density:g} kg/m^3, 1e-6 m^2/s",
                         [dam_break(fluid=liquid(density, 1e-6))], checks))
    made.append(Case("nu_1e+03_no_slip", "liquids", "dam break with walls that hold it, 1000 m^2/s",
                     [dam_break(fluid=liquid(1000, 1e3), walls="no_slip")], checks))
    for nu in (0, 1e3):
        made.append(Case(f"nu_{nu:.0e}_in_space", "liquids", f"dam break in space, kinematic viscosity {nu:g} m^2/s",
                         [dam_break_in_space(fluid=liquid(1000, nu))], checks))
    return made
