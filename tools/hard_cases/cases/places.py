"""Particles exactly where formulas change: on nodes, on faces of cells, on walls, in corners, at periodic ends."""

from __future__ import annotations

from case import Case
from checks import ALWAYS, ENERGY, FLIGHT, MOMENTUM
from scenes import Scene, ball, box, down, particle, scene

H = 1 / 4
DT = 1 / 64
HALF_CELL = 0.5 * H / DT  # speed of half a cell per step


def room(particles: list[Scene], steps: int, dimension: int = 2, **more: object) -> Scene:
    """A box of 4 m; a frame per step."""
    return scene([16] * dimension, H, particles, steps * DT, DT, output={"every": DT}, **more)


def free(name: str, what: str, of: Scene) -> Case:
    return Case(name, "places", what, [of], [*ALWAYS, FLIGHT, MOMENTUM, ENERGY])


def walled(name: str, what: str, of: Scene) -> Case:
    return Case(name, "places", what, [of], [*ALWAYS, ENERGY])


def cases() -> list[Case]:
    made = [
        free("on_nodes", "one particle, at every second step on a node",
             room([particle([3, 3], H, 1, [HALF_CELL, HALF_CELL])], 12)),
        free("on_nodes_at_half_steps", "one particle, in the middle of every second step on a node",
             room([particle([3, 3], H, 1, [2 * HALF_CELL, 2 * HALF_CELL])], 8)),
        free("on_faces", "one particle, at every second step on a face between cells",
             room([particle([3, 3], H, 1, [HALF_CELL, 0.0])], 12)),
        free("across_a_periodic_end", "a drop that crosses the ends of a periodic axis",
             room([ball([2.0, 2.0], 0.5, 2, [HALF_CELL, 0.0])], 48, walls={"x": "periodic", "y": "slip"})),
        free("on_nodes_in_space", "one particle, at every second step on a node",
             room([particle([3, 3, 3], H, 1, [HALF_CELL] * 3)], 12, 3)),
    ]
    # Periodic images have no parabola to be compared with.
    made[3] = Case(made[3].name, "places", made[3].what, made[3].scenes, [*ALWAYS, MOMENTUM, ENERGY])
    for wall in ("slip", "no_slip"):
        text = wall.replace("_", "-")
        made += [
            walled(f"into_a_wall_{wall}", f"one particle that reaches a {text} wall exactly and stays there",
                   room([particle([2, 6], H, 1, [-HALF_CELL, 0.0])], 64, walls=wall)),
            walled(f"into_a_corner_{wall}", f"one particle that reaches a corner of {text} walls exactly",
                   room([particle([2, 2], H, 1, [-HALF_CELL, -HALF_CELL])], 64, walls=wall)),
            walled(f"corner_under_gravity_{wall}", f"one particle that falls into a corner of {text} walls",
                   room([particle([0, 4], H, 2, [-1.0, 0.0])], 128, walls=wall, body_force=down(2))),
            walled(f"corner_in_space_{wall}", f"one particle that reaches a corner of {text} walls exactly",
                   room([particle([2, 2, 2], H, 1, [-HALF_CELL] * 3)], 64, 3, walls=wall)),
        ]
    made.append(walled("pile_in_a_corner", "eight particles of one cell thrown into a corner, under gravity",
                       room([box([0.5, 0.5], [0.75, 0.75], 2, [-16.0, -16.0]), box([1.0, 1.0], [1.25, 1.25], 2,
                                                                                  [-32.0, -32.0])],
                            128, body_force=down(2))))
    return made
