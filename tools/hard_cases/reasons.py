"""What exceptions have in common, in words; each with the broken checks that it is likely to explain."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from case import Case, Check
from methods import Method

GAINED = ("energy", "speed", "pressure")


@dataclass(frozen=True)
class Reason:
    text: str
    explains: Callable[[Case, Check, Method], bool]


def squeezes(case: Case, check: Check, method: Method) -> bool:
    return check.name == "volume"


# A broken check goes to the first reason that explains it.
REASONS = [
    Reason("*No way out to the side.* In `sheet_upright` particles stand exactly above each other. The water spreads, but "
           "they stay on one line: nothing pushes them to the left or to the right, and a volume correction has no "
           "direction either.",
           lambda case, check, method: case.name == "sheet_upright" and check.name == "volume"),
    Reason("*Faces without mass.* Of the conforming discretization a face next to a lone particle weighs at least 1e-8 of a "
           "full one, (E78). Where a particle meets a node, some faces around it have no mass and thus no velocity, and they "
           "take 1e-8 of its speed.",
           lambda case, check, method: method.discretization == "conforming" and check.name == "flight"),
    Reason("*Momentum at light nodes.* A pressure also pushes nodes that are too light to be solved for, (E15), and that "
           "push is lost. In a drop it is less than 1e-5 of the momentum; of two lone particles that meet it is more.",
           lambda case, check, method: check.name in ("momentum", "centre")),
    Reason("*Work of the volume correction.* It moves particles, also against gravity. A column four cells deep wanders "
           "around its level by a per cent and creeps for ever; without a trend.",
           lambda case, check, method: case.name == "column_of_a_million_steps" and check.name in ("energy", "drift", "level")),
    Reason("*Waves that last.* Between slip walls a wave in water lives for hours: the first standing wave of the tank, "
           "most of what TPIC still moves after a minute, loses 0.7 % of its energy in that time. Between no-slip walls "
           "the layer at the floor, a twentieth of a cell thick, takes 43 % of its amplitude (G. H. Keulegan, J. Fluid "
           "Mech. 6 (1959) 33).",
           lambda case, check, method: case.name == "dam_break_60_s"
           or (case.name == "no_slip_dam_break_60_s" and check.name == "rest" and method.scheme != "flip")),
    Reason("*Noise of FLIP at rest.* Its particles keep velocities against each other that the grid does not see; the level "
           "is not moved by them.",
           lambda case, check, method: (case.name.endswith("dam_break_60_s") and check.name == "rest"
                                        and method.scheme == "flip")),
    Reason("*Newmark's method after impacts.* With beta = 1/4 and gamma = 1/2 it carries the acceleration from step to step "
           "and never damps it. An impact, or a long step after a short one, leaves an oscillation that grows where the "
           "steps are long or the volume is corrected. The midpoint rule, the default, carries none.",
           lambda case, check, method: method.integrator == "newmark" and check.name in GAINED),
    Reason("*Steps too long for the correction.* The volume correction gives back 15 % of the excess per step. With "
           "steps in which the water crosses a cell or more, an impact squeezes faster than that.", squeezes),
    Reason("*Noise of FLIP and of pushed particles.* FLIP keeps velocities that the grid does not see, and the delta "
           "correction moves particles one by one; both come back as energy where cells hold few particles.",
           lambda case, check, method: method.integrator == "midpoint" and check.name in GAINED),
]


def reason(case: Case, check: Check, method: Method) -> int | None:
    """Which one explains that a method broke a check of a case; none if that is not understood."""
    return next((k for k, one in enumerate(REASONS) if one.explains(case, check, method)), None)
