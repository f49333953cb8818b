"""All cases, in the order of the page."""

from __future__ import annotations

from case import Case
from cases import bodies, boxes, dam_breaks, endurance, falling, impact, liquids, places, seeds, symmetry, units

CASES: list[Case] = [case for module in (falling, places, impact, dam_breaks, liquids, units, seeds, boxes, bodies,
                                         symmetry, endurance) for case in module.cases()]
SECTIONS = list(dict.fromkeys(case.section for case in CASES))
ABOUT = {module.__name__.split(".")[-1]: (module.__doc__ or "").strip().replace("\n", " ")
         for module in (falling, places, impact, dam_breaks, liquids, units, seeds, boxes, bodies, symmetry, endurance)}
