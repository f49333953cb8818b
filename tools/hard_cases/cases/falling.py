"""Particles that nothing holds: every one flies on its parabola, or their centre of mass does."""

from __future__ import annotations

from case import Case
from checks import ALWAYS, CENTRE, ENERGY, FLIGHT, MOMENTUM
from scenes import Scene, ball, box, down, particle, scene

H = 1 / 4
V = [1.0, 0.5]


def sky(particles: list[Scene], dimension: int = 2, **more: object) -> Scene:
    """A box of 4 m in which nothing meets a wall within 0.4 s."""
    return scene([16] * dimension, H, particles, 0.4, 0.02, body_force=down(dimension), **more)


def case(name: str, what: str, scenes: list[Scene], exact: bool = True, energy: bool = True) -> Case:
    checks = [*ALWAYS, MOMENTUM, FLIGHT if exact else CENTRE] + ([ENERGY] if energy else [])
    return Case(name, "falling", what, scenes, checks)


def cases() -> list[Case]:
    up = [0.5, 0.25, 0.5]
    return [
        case("lone_particle", "one particle, on the border of four dual cells",
             [sky([particle([6, 10], H, 1, V)])]),
        case("lone_small_particle", "one particle, 1/256 of a cell", [sky([particle([6, 10], H, 16, V)])]),
        case("pair_apart", "two particles with different velocities, six cells apart",
             [sky([particle([3, 10], H, 1, V), particle([9, 10], H, 1, [-0.5, 0.25])])]),
        case("pair_together", "two particles with the same velocity in neighbouring cells",
             [sky([particle([6, 10], H, 1, V), particle([7, 10], H, 1, V)])]),
        case("pair_in_a_cell", "two particles with the same velocity in one cell",
             [sky([box([1.5, 2.5], [1.75, 2.625], 2, V)])]),
        case("pair_meeting", "two particles that fly into each other",
             [sky([particle([5, 10], H, 1, [2.0, 0.5]), particle([7, 10], H, 1, [-2.0, 0.5])])], exact=False),
        case("pair_of_unequal_mass", "a particle of a cell and one of 1/256 next to it, same velocity",
             [sky([particle([6, 10], H, 1, V), particle([7, 10], H, 16, V)])]),
        case("dust_beside_a_drop", "a drop, and a particle so light that its nodes are not active",
             [sky([ball([2.0, 2.75], 0.5, 2, V), particle([11, 11], H, 16, V)])]),
        case("drop", "a drop in free fall", [sky([ball([2.0, 2.75], 0.5, 2, V)])]),
        case("lone_particle_in_space", "one particle, on the border of eight dual cells",
             [sky([particle([6, 6, 10], H, 1, up)], 3)]),
        case("pair_meeting_in_space", "two particles that fly into each other",
             [sky([particle([5, 6, 10], H, 1, [2.0, 0.25, 0.5]), particle([7, 6, 10], H, 1, [-2.0, 0.25, 0.5])], 3)],
             exact=False),
    ]
