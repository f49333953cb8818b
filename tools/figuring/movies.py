"""Movies: every frame of the runs, side by side, as MP4."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
from matplotlib.animation import FFMpegWriter

from figuring.fields import Field
from figuring.layout import Margins, Sheet
from figuring.panels import Look, draw_panel
from figuring.strips import scale
from figuring.views import Slice, View, plane_of, view_of
from reporting.runs import NoResults, Run, labels

DOTS_PER_INCH = 160  # 1152 pixels across
MOST_IN_A_ROW = 3
SAMPLES = 12  # frames that colours and view are chosen for
SECONDS = 6  # that a movie lasts if nothing else is asked for


def check_ffmpeg() -> None:
    """Before anything is drawn."""
    if not shutil.which("ffmpeg"):
        raise NoResults("ffmpeg, which writes movies, is not installed: sudo apt-get install ffmpeg; "
                        "or leave the movie out: --no-movie")


def frames_per_second(count: int) -> int:
    """So that the movie lasts SECONDS, but is neither a slide show nor too fast to follow."""
    return int(np.clip(round(count / SECONDS), 4, 30))


def write_movie(path: Path, runs: list[Run], field: Field, cut: Slice | None, per_second: int | None) -> None:
    """A picture per frame of the longest run. The others show their last frame before that time."""
    times = max((run.times for run in runs), key=lambda times: (times[-1], len(times)))
    rows = [runs[k:k + MOST_IN_A_ROW] for k in range(0, len(runs), MOST_IN_A_ROW)]
    samples = [(run, int(index)) for run in runs
               for index in np.unique(np.linspace(0, len(run.times) - 1, SAMPLES).round())]
    norm, extend = scale(field, samples, cut)
    views = [[_view(run, samples, cut) for run in row] for row in rows]
    sheet = Sheet(views, _margins(runs, cut))
    sheet.add_colour_bar(field, norm, extend)
    if len(runs) > 1:
        for k, name in enumerate(labels(runs)):
            sheet.name_panel(k // MOST_IN_A_ROW, k % MOST_IN_A_ROW, name)
    cells = [cell for row in zip(sheet.panels, rows, views) for cell in zip(*row)]

    def draw(time: float) -> None:
        sheet.head.set_text((f"{cut.name},  " if cut else "") + f"$t$ = {_written(time, times)} s")
        for panel, run, view in cells:
            panel.clear()
            draw_panel(panel, Look(field, norm, cut), run, _last_until(run, time), time, view)
        sheet.dress()

    draw(times[-1])
    sheet.settle()
    writer = FFMpegWriter(fps=per_second or frames_per_second(len(times)), codec="h264",
                          extra_args=["-crf", "20", "-movflags", "+faststart", "-threads", "1"])
    with writer.saving(sheet.figure, str(path), DOTS_PER_INCH):
        for time in times:
            draw(time)
            writer.grab_frame()


def _view(run: Run, samples: list[tuple[Run, int]], cut: Slice | None) -> View:
    shown = [other.columns(index)["position"] for other, index in samples if np.array_equal(other.box, run.box)]
    return view_of(run, shown, cut)


def _last_until(run: Run, time: float) -> int:
    """The frame at a time, or the last one before."""
    return max(0, int(np.searchsorted(run.times, time + 1e-3 * run.times[-1])) - 1)


def _written(time: float, times: np.ndarray) -> str:
    """With the digits that tell the output times apart."""
    finest = float(np.min(np.diff(times))) if len(times) > 1 else 1.0
    return f"{time:.{max(0, int(np.ceil(-np.log10(finest) - 1e-9)))}f}"


def _margins(runs: list[Run], cut: Slice | None) -> Margins:
    in_space = all(plane_of(run, cut) is None for run in runs)
    return Margins(left=0.18 if in_space else 0.5, bottom=0.15 if in_space else 0.42,
                   top=0.55 if len(runs) > 1 else 0.35, down=0.35)
