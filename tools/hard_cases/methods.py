"""The methods that every case runs with, and how a list of them reads."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import product
from typing import Any, NamedTuple

SCHEMES = ("pic", "flip", "tpic", "tpic2", "apic", "xpic", "fmpm")
INTEGRATORS = ("newmark", "midpoint")
VOLUMES = ("none", "delta", "projection")


class Method(NamedTuple):
    scheme: str
    integrator: str
    volume: str

    @property
    def name(self) -> str:
        return "_".join(self)

    def of(self, scene: dict[str, Any]) -> dict[str, Any]:
        """The scene with this method; all that is not said is the default."""
        return scene | {"transfer": {"scheme": self.scheme}, "integrator": {"scheme": self.integrator},
                        "volume": {"scheme": self.volume}}


METHODS = [Method(*names) for names in product(SCHEMES, INTEGRATORS, VOLUMES)]
DEFAULT = Method("tpic2", "midpoint", "projection")


def listed(methods: Iterable[Method]) -> str:
    """In words, schemes with the same rest together: "tpic, apic with newmark, none"."""
    chosen = set(methods)
    if chosen == set(METHODS):
        return "every method"
    rests_of: dict[tuple[str, ...], list[tuple[str, str]]] = {}
    for rest in product(INTEGRATORS, VOLUMES):
        schemes = tuple(scheme for scheme in SCHEMES if Method(scheme, *rest) in chosen)
        if schemes:
            rests_of.setdefault(schemes, []).append(rest)
    return "; ".join(f"{'every scheme' if schemes == SCHEMES else ', '.join(schemes)} with {rests_text(rests)}"
                     for schemes, rests in rests_of.items())


def rests_text(rests: list[tuple[str, str]]) -> str:
    """Integrators and volume schemes."""
    if len(rests) == len(INTEGRATORS) * len(VOLUMES):
        return "any integrator and volume scheme"
    volumes_of: dict[tuple[str, ...], list[str]] = {}
    for integrator in INTEGRATORS:
        volumes = tuple(volume for volume in VOLUMES if (integrator, volume) in rests)
        if volumes:
            volumes_of.setdefault(volumes, []).append(integrator)
    return ", ".join(f"{' or '.join(integrators)} and {'any' if volumes == VOLUMES else ' or '.join(volumes)} volume"
                     for volumes, integrators in volumes_of.items())
