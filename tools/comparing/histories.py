"""The difference of two histories: its root mean square over the common time, and where it is largest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reporting.runs import Run

ROUNDING = 1e-9  # of the range of the largest component of a vector, or of the values themselves


@dataclass(frozen=True)
class Difference:
    """Of a column of a run from that of the last run."""

    column: str
    unit: str
    range: float  # of the last run over the common time, largest less smallest value
    rms: float
    largest: float  # in magnitude
    time: float  # of the largest [s]
    is_rounding: bool  # the column is nothing but that in the last run

    def relative(self, value: float) -> float:
        """In parts of the range; not a number where there is none to compare with."""
        if value == 0:
            return 0.0
        return np.nan if self.is_rounding or self.range == 0 else value / self.range


def samples(run: Run, column: str, end: float) -> tuple[np.ndarray, np.ndarray]:
    """Times and values up to the end of the common time, without empty ones."""
    times, values = run.history["time"], run.history[column]
    kept = np.isfinite(values)
    times, values = times[kept], values[kept]
    before = times < end
    if len(times) == 0 or times[-1] < end:
        return times[before], values[before]
    return np.append(times[before], end), np.append(values[before], np.interp(end, times, values))


def difference_over_time(run: Run, last: Run, column: str, end: float) -> tuple[np.ndarray, np.ndarray]:
    """At all times of either run; between its rows a history is linear."""
    (t_a, a), (t_b, b) = samples(run, column, end), samples(last, column, end)
    if len(t_a) == 0 or len(t_b) == 0:
        return np.empty(0), np.empty(0)
    times = np.union1d(t_a, t_b)
    times = times[(times >= max(t_a[0], t_b[0])) & (times <= min(t_a[-1], t_b[-1]))]
    return times, np.interp(times, t_a, a) - np.interp(times, t_b, b)


def difference(run: Run, last: Run, column: str, end: float) -> Difference:
    """Of one column, up to the end of the common time."""
    times, values = difference_over_time(run, last, column, end)
    if len(times) == 0:
        return Difference(column, last.units.get(column, ""), np.nan, np.nan, np.nan, np.nan, False)
    at = int(np.argmax(np.abs(values)))
    return Difference(column, last.units.get(column, ""), _range(last, column, end), _root_mean_square(times, values),
                      float(abs(values[at])), float(times[at]), _is_rounding(last, column, end))


def _root_mean_square(times: np.ndarray, values: np.ndarray) -> float:
    """Over time, for steps differ in length; of a difference that is linear from one time to the next."""
    steps = np.diff(times)
    if steps.sum() == 0:
        return float(abs(values[0]))
    first, second = values[:-1], values[1:]
    return float(np.sqrt(np.sum(steps * (first**2 + first * second + second**2)) / 3 / steps.sum()))


def _range(run: Run, column: str, end: float) -> float:
    values = samples(run, column, end)[1]
    return float(np.ptp(values)) if len(values) else np.nan


def _is_rounding(run: Run, column: str, end: float) -> bool:
    """Whether a value never changes, or is a component of a vector that is zero next to the others."""
    own = _range(run, column, end)
    values = samples(run, column, end)[1]
    stem, _, axis = column.rpartition("_")
    others = [f"{stem}_{other}" for other in "xyz" if other != axis] if axis in ("x", "y", "z") else []
    scale = max([float(np.abs(values).max()), *(_range(run, other, end) for other in others if other in run.history)])
    return own <= ROUNDING * scale
