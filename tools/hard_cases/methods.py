"""The methods that every case runs with, and how a list of them reads."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import product
from typing import Any, NamedTuple

SCHEMES = ("pic", "flip", "tpic", "tpic2", "apic", "xpic", "fmpm")
INTEGRATORS = ("newmark", "midpoint")
VOLUMES_OF = {"equal_order": ("none", "delta", "projection"), "conforming": ("none", "projection")}
DISCRETIZATIONS = tuple(VOLUMES_OF)
VOLUMES = VOLUMES_OF["equal_order"]  # all of them


class Method(NamedTuple):
    scheme: str
    integrator: str
    volume: str
    discretization: str = "equal_order"

    @property
    def name(self) -> str:
        """Of the default discretization only the rest is said."""
        return "_".join(self if self.discretization != "equal_order" else self[:3])

    def of(self, scene: dict[str, Any]) -> dict[str, Any]:
        """The scene with this method; all that is not said is the default."""
        return scene | {"transfer": {"scheme": self.scheme}, "integrator": {"scheme": self.integrator},
                        "volume": {"scheme": self.volume}, "discretization": {"scheme": self.discretization}}


METHODS = [Method(scheme, integrator, volume, discretization) for discretization in DISCRETIZATIONS
           for scheme, integrator, volume in product(SCHEMES, INTEGRATORS, VOLUMES_OF[discretization])]
# Bodies are cut through the staggered grid, and move with the midpoint rule.
METHODS_OF_BODIES = [method for method in METHODS
                     if method.discretization == "conforming" and method.integrator == "midpoint"]
DEFAULT = Method("tpic2", "midpoint", "projection")


def methods_of(discretization: str) -> list[Method]:
    return [method for method in METHODS if method.discretization == discretization]


def listed(methods: Iterable[Method]) -> str:
    """In words, of one discretization, schemes with the same rest together: "tpic, apic with newmark, none"."""
    chosen = set(methods)
    discretization = next(iter(chosen)).discretization
    if chosen == set(methods_of(discretization)):
        return "every method"
    volumes = VOLUMES_OF[discretization]
    rests_of: dict[tuple[str, ...], list[tuple[str, str]]] = {}
    for rest in product(INTEGRATORS, volumes):
        schemes = tuple(scheme for scheme in SCHEMES if Method(scheme, *rest, discretization) in chosen)
        if schemes:
            rests_of.setdefault(schemes, []).append(rest)
    return "; ".join(f"{'every scheme' if schemes == SCHEMES else ', '.join(schemes)} with {rests_text(rests, volumes)}"
                     for schemes, rests in rests_of.items())


def rests_text(rests: list[tuple[str, str]], all_volumes: tuple[str, ...]) -> str:
    """Integrators and volume schemes."""
    if len(rests) == len(INTEGRATORS) * len(all_volumes):
        return "any integrator and volume scheme"
    volumes_of: dict[tuple[str, ...], list[str]] = {}
    for integrator in INTEGRATORS:
        volumes = tuple(volume for volume in all_volumes if (integrator, volume) in rests)
        if volumes:
            volumes_of.setdefault(volumes, []).append(integrator)
    return ", ".join(f"{' or '.join(integrators)} and {'any' if volumes == all_volumes else ' or '.join(volumes)} volume"
                     for volumes, integrators in volumes_of.items())
