"""All cases, in the order of the page."""

from __future__ import annotations

from case import Case
from cases import (bodies, boxes, dam_breaks, endurance, falling, impact, liquids, openings, places, seeds, symmetry,
                   units)

MODULES = (falling, places, impact, dam_breaks, liquids, units, seeds, boxes, bodies, openings, symmetry, endurance)
CASES: list[Case] = [case for module in MODULES for case in module.cases()]
SECTIONS = list(dict.fromkeys(case.section for case in CASES))
ABOUT = {module.__name__.split(".")[-1]: (module.__doc__ or "").strip().replace("\n", " ") for module in MODULES}
