"""Solids in the water: walls across the grid, moved bodies, bodies that float, fall and collide."""

from __future__ import annotations

import numpy as np

from case import Case, Check
from checks import ALWAYS, BALANCE, VOLUME, worst
from methods import METHODS_OF_BODIES
from runs import Run
from scenes import Scene, box, down, scene, with_cfl

N = 32
H = 1 / N
SLOPE = 60  # of the plate, in degrees


def tank(bodies: list[Scene], water: list[Scene] | None = None, end: float = 1.0, step: float = 4e-3,
         **more: object) -> Scene:
    """A tank of 1 m, half full if nothing else is said."""
    return scene([N, N], H, water or [box([0, 0], [1, 0.5])], end, step, body_force=down(2), bodies=bodies) | more


def body(name: str, shape: Scene, motion: Scene | None = None) -> Scene:
    return {"name": name, "shape": shape} | ({"motion": motion} if motion else {})


def slab(low: list[float], high: list[float], angle: float = 0) -> Scene:
    return {"box": {"low": low, "high": high} | ({"angle": angle} if angle else {})}


def disc(center: list[float], radius: float) -> Scene:
    return {"ball": {"center": center, "radius": radius}}


def moved(x: str = "0", y: str = "0") -> Scene:
    return {"prescribed": {"velocity": [x, y]}}


def free(density: float, **more: object) -> Scene:
    return {"free": {"density": density} | more}


def beyond_plate(run: Run) -> float:
    """Particles on the other side of the plate through (0.5, 0.5) that the water lies to the left of."""
    slope = np.tan(np.radians(SLOPE))
    return float(max(np.count_nonzero(frame.position[:, 1] < 0.5 + slope * (frame.position[:, 0] - 0.5))
                     for frame in run.frames))


BEYOND = Check("beyond", "let water through a plate", worst(beyond_plate), 0, "particles", garbage=True)


def case(name: str, what: str, of: Scene, *more: Check, long: bool = False) -> Case:
    return Case(name, "bodies", what, [of], [*ALWAYS, BALANCE, VOLUME, *more], methods=METHODS_OF_BODIES, long=long)


def walls() -> list[Case]:
    """Bodies at rest."""
    column = [box([0, 0], [0.3, 0.6])]
    obstacle = tank([body("block", slab([0.55, -0.1], [0.7, 0.21]))], column)
    beach = tank([body("beach", {"polygon": {"vertices": [[0.3, -0.1], [1.2, -0.1], [1.2, 0.8]]}})], column)
    wedge = {"polygon": {"vertices": [[-1, -1], [2, -1], [2, 2], [0.6, 1.1], [0.5, 0.1], [0.4, 1.1], [-1, 2]]}}
    slope = np.tan(np.radians(SLOPE))
    plate = tank([body("plate", slab([-0.5, 0.5 - 0.025 * H], [1.5, 0.5 + 0.025 * H], SLOPE))],
                 [{"shape": {"where": f"y < 0.6 && y > 0.5 + {slope}*(x - 0.5)"}, "per_cell": 2}])
    return [
        case("obstacle", "a dam break against a block", obstacle),
        case("obstacle_cfl_2", "the same, CFL number 2", with_cfl(obstacle, 2)),
        case("beach", "a dam break onto a slope", beach),
        case("beach_cfl_2", "the same, CFL number 2", with_cfl(beach, 2)),
        case("turned_tank", "a dam break in a tank that lies across the grid",
             scene([N, N], 2 * H, [{"shape": {"where": "x < 0.9"}, "per_cell": 2}], 1.0, 4e-3, body_force=down(2),
                   bodies=[body("tank", {"invert": slab([0.5, 0.5], [1.5, 1.5], 25)})])),
        case("funnel", "water that falls into a notch that ends in nothing",
             tank([body("wedge", wedge)], [box([0.4, 0.8], [0.6, 1.0])])),
        case("pillars", "a dam break between pillars that are a cell apart",
             tank([body(f"pillar_{k}", disc([0.6, 0.09 + 0.09 * k], 0.03)) for k in range(4)], column)),
        case("slit", "water that runs out under a gate, through half a cell",
             tank([body("gate", slab([0.4, 0.5 * H], [0.5, 1.2]))], [box([0, 0], [0.4, 0.5])])),
        case("thin_plate", "a plate of 1/20 cell, askew, with water on one side", plate, BEYOND),
        case("thin_plate_cfl_1", "the same, CFL number 1", with_cfl(plate, 1), BEYOND),
        case("obstacle_in_space", "a dam break against a ball",
             scene([12, 6, 12], 1 / 12, [box([0, 0, 0], [0.25, 0.5, 0.5])], 0.5, 8e-3, body_force=down(3),
                   bodies=[body("ball", {"ball": {"center": [0.6, 0.25, 0.1], "radius": 0.15}})])),
    ]


def moving() -> list[Case]:
    """Bodies that are moved."""
    def paddle(stroke: float, omega: float, step: float) -> Scene:
        return scene([2 * N, N // 2], H, [box([0, 0], [2, 0.25])], 1.5, step, body_force=down(2), bodies=[
            body("paddle", slab([-1, -1], [0.12, 2]), moved(f"{stroke * omega}*sin({omega}*t)"))])

    def mixer(rate: float, step: float) -> Scene:
        cross = {"union": [slab([0.2, 0.47], [0.8, 0.53]), slab([0.47, 0.2], [0.53, 0.8])]}
        motion = {"prescribed": {"rotation": {"center": [0.5, 0.5], "rate": f"{rate}*min(t/0.2, 1)"}}}
        return tank([body("cross", cross, motion)], end=0.8, step=step)

    plunge = moved(y="-0.25*6*sin(6*t)")
    return [
        case("paddle_slow", "a paddle that makes waves", paddle(0.05, 4, 4e-3)),
        case("paddle_fast", "a paddle that is faster than the waves", paddle(0.1, 12, 4e-3)),
        case("paddle_fast_short_steps", "the same, a quarter of the step", paddle(0.1, 12, 1e-3)),
        case("paddle_cfl_2", "the same, CFL number 2", with_cfl(paddle(0.1, 12, 4e-3), 2)),
        case("mixer", "a cross that turns in a tank", mixer(3, 4e-3)),
        case("mixer_fast", "the same, its ends at 3 m/s", mixer(10, 4e-3)),
        case("mixer_fast_short_steps", "the same, a quarter of the step", mixer(10, 1e-3)),
        case("plunger", "a disc that goes through the surface and back",
             tank([body("disc", disc([0.5, 0.75], 0.1), plunge)], end=1.2)),
        case("disc_in_a_full_tank", "a disc that is moved through a tank without a surface",
             tank([body("disc", disc([0.4, 0.5], 0.12), moved("0.1*8*sin(8*t)"))], [box([0, 0], [1, 1])])),
        case("thin_paddle", "a paddle of 1/5 cell, water on both sides",
             tank([body("plate", slab([0.5 - 0.1 * H, -0.5], [0.5 + 0.1 * H, 1.5]), moved("0.05*6*sin(6*t)"))])),
        case("gate_opens", "a dam break behind a gate that is pulled up",
             tank([body("gate", slab([0.3, -0.1], [0.4, 1.2]), moved(y="2*min(t/0.1, 1)"))],
                  [box([0, 0], [0.3, 0.5])], end=0.8)),
        case("mixer_in_space", "a bar that turns in a tank in 3-D",
             scene([12, 12, 12], 1 / 12, [box([0, 0, 0], [1, 1, 0.5])], 0.4, 8e-3, body_force=down(3), bodies=[
                 body("bar", {"box": {"low": [0.15, 0.4, 0.2], "high": [0.85, 0.6, 0.35]}},
                      {"prescribed": {"rotation": {"center": [0.5, 0.5, 0.27], "axis": [0, 0, 1],
                                                   "rate": "4*min(t/0.1, 1)"}}})])),
    ]


def floating() -> list[Case]:
    """Bodies that move with the water."""
    def one(shape: Scene, density: float, step: float = 4e-3, end: float = 1.0, **more: object) -> Scene:
        return tank([body("box", shape, free(density, **more))], end=end, step=step)

    square = slab([0.4, 0.42], [0.6, 0.62], 10)
    high = slab([0.4, 0.7], [0.6, 0.85], 20)
    low = slab([0.4, 0.15], [0.6, 0.35], 10)
    return [
        case("float", "a box of half the density of water, not upright", one(square, 500)),
        case("float_cfl_1", "the same, CFL number 1", with_cfl(one(square, 500), 1)),
        case("float_light", "a box of 1/100 of the density of water, at the bottom", one(low, 10)),
        case("float_light_short_steps", "the same, a quarter of the step", one(low, 10, 1e-3)),
        case("sink_heavy", "a box of 100 times the density of water", one(high, 1e5)),
        case("drop_a_box", "a box that falls into the water", one(high, 600)),
        case("drop_a_box_cfl_1", "the same, CFL number 1", with_cfl(one(high, 600), 1)),
        case("throw_a_disc", "a disc with 5 m/s and a turn that meets the water",
             one(disc([0.3, 0.75], 0.08), 900, velocity=[3, -4], rotation=20)),
        case("neutral_disc_in_a_full_tank", "a disc as dense as water, in a tank without a surface",
             tank([body("disc", disc([0.4, 0.5], 0.12), free(1000, velocity=[1, 0]))], [box([0, 0], [1, 1])])),
        case("piston_in_a_shaft", "a box that falls onto water in a shaft, with gaps of a quarter of a cell",
             tank([body("left", slab([-1, -1], [0.3, 2])), body("right", slab([0.7, -1], [2, 2])),
                   body("box", slab([0.3 + H / 4, 0.6], [0.7 - H / 4, 0.8]), free(2000))],
                  [box([0.3, 0], [0.7, 0.5])])),
        case("stack", "three boxes that fall onto each other into the water",
             tank([body(f"box_{k}", slab([0.4 + 0.03 * k, 0.55 + 0.14 * k], [0.58 + 0.03 * k, 0.65 + 0.14 * k]),
                        free(700)) for k in range(3)])),
        case("moored", "a disc under water that a spring holds",
             one(disc([0.5, 0.25], 0.1), 200, spring={"to": [0.5, 0.25], "stiffness": 2000, "damping": 5})),
        case("float_in_space", "a block that falls into the water",
             scene([12, 12, 12], 1 / 12, [box([0, 0, 0], [1, 1, 0.5])], 0.5, 8e-3, body_force=down(3), bodies=[
                 body("block", {"box": {"low": [0.3, 0.3, 0.55], "high": [0.7, 0.7, 0.8]}}, free(500))])),
    ]


def cases() -> list[Case]:
    return walls() + moving() + floating()
