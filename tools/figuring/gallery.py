"""The pictures of scenes/GALLERY.md: which scenes, which moments of them, and how they are drawn."""

from __future__ import annotations

import io
import shlex
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from PIL import Image

from figuring.fields import find_field
from figuring.layout import png
from figuring.scene_runs import Settings, setting_arguments
from figuring.strips import Strip, draw_strip
from figuring.views import Slice, View
from reporting.references import read_references
from reporting.runs import Run

DOTS_PER_INCH = 125  # 900 pixels across, as a page shows them
LARGEST = 150_000  # of a picture [bytes]


@dataclass(frozen=True)
class Exhibit:
    """One scene of the gallery."""

    scene: str  # from scenes/, without .json
    times: tuple[float, ...]  # [s]
    field: str = "speed"
    across: int = 1  # panels in a row
    part: tuple[tuple[float, float], tuple[float, float]] | None = None  # low and high corner [m]; none: all
    cut: Slice | None = None  # of a run in 3-D
    reference: str | None = None  # from scenes/reference; its lines are drawn over the particles
    settings: Settings = ()

    @property
    def name(self) -> str:
        return Path(self.scene).name

    @property
    def command(self) -> str:
        """What runs it, as the page says it."""
        return shlex.join(["tools/run", f"scenes/{self.scene}.json", *setting_arguments(self.settings)])


GALLERY = (
    Exhibit("obstacle", (0.2, 0.3), across=2, reference="obstacle_interfoam"),
    Exhibit("validation/box_in_the_way", (0.5, 1.0)),
    Exhibit("weir", (12.0,), settings=(("/particles/1/shape/box/high", [3.2, 0.18]),
                                       ("/openings/1/outflow/level", 0.24))),
    Exhibit("hydraulic_jump", (8.0,), part=((1.0, 0.0), (3.6, 0.3))),
    Exhibit("jet_on_plate", (1.8, 6.0), "pressure", across=2),
    Exhibit("paddle", (4.5, 5.3)),
    Exhibit("floating_box", (0.2, 0.5, 1.0, 5.0), across=2),
    Exhibit("lock_exchange", (2.0, 6.0), "fluid"),
    Exhibit("mixer", (1.0, 4.0), across=2),
    Exhibit("slump_3d", (0.0, 0.1, 0.2, 1.0), across=4, part=((0.0, 0.0), (0.2, 0.31)), cut=Slice(1, 0.005),
            settings=(("/grid/cells", [40, 40, 32]),)),
    Exhibit("ligament", (0.0, 8.0, 9.0, 14.0), across=2),
    Exhibit("crown", (5e-4, 1.2e-3), across=2, settings=(("/time/end", 1.21e-3),)),
)


def draw_exhibit(exhibit: Exhibit, run: Run, references: Path) -> Figure:
    """The run of an exhibit at its times."""
    part = View(*map(np.array, exhibit.part), whole=False) if exhibit.part else None
    lines = read_references(references / exhibit.reference) if exhibit.reference else []
    return draw_strip(Strip([run], list(exhibit.times), find_field([run], exhibit.field), lines, cut=exhibit.cut,
                            across=exhibit.across, part=part))


def picture_of(figure: Figure) -> bytes:
    """A PNG file with as many colours as fit into the bytes that a picture may have."""
    image = Image.open(io.BytesIO(png(figure, DOTS_PER_INCH))).convert("RGB")
    for colours in (256, 128, 64):
        file = io.BytesIO()
        # Moved to their means: fewer bands in what is smooth.
        image.quantize(colours, kmeans=1, dither=Image.Dither.NONE).save(file, "PNG", optimize=True)
        if file.tell() <= LARGEST:
            break
    return file.getvalue()
