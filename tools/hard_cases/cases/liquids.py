"""Liquids from inviscid to stiff, from a gas to a metal and far beyond."""

from __future__ import annotations

from case import Case
from checks import ALWAYS, ENERGY, FINITE, PARTICLES, SPEED, VOLUME
from methods import METHODS, METHODS_OF_BODIES
from scenes import Scene, box, dam_break, dam_break_in_space, down, scene

N = 32
MIDPOINT = METHODS_OF_BODIES
CONFORMING = [method for method in METHODS if method.discretization == "conforming"]


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
        made.append(Case(f"nu_{nu:.0e}_in_space", "liquids", f"dam break in 3-D, kinematic viscosity {nu:g} m^2/s",
                         [dam_break_in_space(fluid=liquid(1000, nu))], checks))
    return made + drops() + several()


def several() -> list[Case]:
    """Two liquids in a tank."""
    checks = [FINITE, PARTICLES, SPEED, VOLUME]

    def two(heavy: float, light: float, heavy_above: bool, nu: float = 1e-6) -> Scene:
        made = scene([N, N], 1 / N, [box([0, 0], [1, 0.25], fluid="light" if heavy_above else "heavy"),
                                     box([0, 0.25], [0.5, 0.5], fluid="heavy" if heavy_above else "light")],
                     1.0, 4e-3, body_force=down(2))
        del made["fluid"]
        return made | {"fluids": {"heavy": {"density": heavy, "viscosity": heavy * nu},
                                  "light": {"density": light, "viscosity": light * nu}}}

    return [
        Case("heavy_on_light", "liquids", "a liquid falls into one of half its density", [two(1000, 500, True)], checks,
             methods=MIDPOINT),
        Case("thousand_on_one", "liquids", "a liquid falls into one of a thousandth of its density",
             [two(1000, 1, True)], [FINITE, PARTICLES, VOLUME], methods=MIDPOINT),  # it may squirt
        Case("one_on_thousand", "liquids", "a liquid spreads on one of a thousand times its density",
             [two(1000, 1, False)], [FINITE, PARTICLES, VOLUME], methods=MIDPOINT),
        Case("heavy_on_light_thick", "liquids", "as heavy_on_light, 1 m^2/s", [two(1000, 500, True, 1.0)], checks,
             methods=MIDPOINT),
    ]


def tension(coefficient: float, angle: float = 90) -> Scene:
    return {"coefficient": coefficient, "contact_angle": angle}


def drops() -> list[Case]:
    """Surface tension and a little weight; the limit of (E116) is 4.1 ms."""
    checks = [*ALWAYS, VOLUME]
    square = [box([0.25, 0.25], [0.75, 0.75])]
    low = [box([0.25, 0], [0.75, 0.25])]
    thick = {"density": 1000.0, "viscosity": 10.0}

    def drop(particles: list[Scene], **more: object) -> Scene:
        return scene([N, N], 1 / N, particles, 0.5, 3e-3, fluid=thick, body_force=down(2, 1)) | more

    return [
        Case("drop_from_square", "liquids", "a square that surface tension makes round",
             [drop(square, surface_tension=tension(72))], checks, methods=CONFORMING),
        Case("drop_wets", "liquids", "a puddle that spreads, contact angle 20 degrees",
             [drop(low, surface_tension=tension(72, 20))], checks, methods=CONFORMING),
        Case("drop_flees", "liquids", "a puddle that leaves the floor, contact angle 175 degrees",
             [drop(low, surface_tension=tension(72, 175))], checks, methods=CONFORMING),
        Case("drops_collide", "liquids", "two squares that run into each other and become one",
             [drop([box([0.125, 0.375], [0.375, 0.625], velocity=[0.5, 0]),
                    box([0.625, 0.375], [0.875, 0.625], velocity=[-0.5, 0])], surface_tension=tension(72))],
             checks, methods=CONFORMING),
        Case("dam_break_of_drops", "liquids", "a dam break with much surface tension",
             [scene([N, N], 1 / N, [box([0, 0], [0.25, 0.5])], 1.0, 1.5e-3, body_force=down(2),
                    surface_tension=tension(72, 60))], checks, methods=CONFORMING),
    ]
