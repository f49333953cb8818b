"""Numbers that compare a curve with the measured one."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from case import Points

Of = Callable[[Points, Points], float]


def shared(ours: Points, measured: Points) -> Points:
    return measured.between(ours.x[0], ours.x[-1])


def rms(low: float = -np.inf, high: float = np.inf) -> Of:
    """Root mean square of the difference at the measured points over the largest of those. [%]"""

    def of(ours: Points, measured: Points) -> float:
        points = shared(ours, measured).between(low, high)
        apart = np.interp(points.x, ours.x, ours.y) - points.y
        return 100 * float(np.sqrt(np.mean(apart**2)) / np.max(np.abs(points.y)))

    return of


def later(measured: Points, delay: float) -> Points:
    """The measured curve, were there no delay."""
    return Points(measured.x - delay, measured.y)


def best_delay(ours: Points, measured: Points, most: float) -> float:
    return min(np.linspace(0, most, 501), key=lambda delay: rms()(ours, later(measured, delay)))


def delay(most: float) -> Of:
    """By which the measured curve is later, from 0 to `most`, where it is nearest to ours. [of the axis]"""
    return lambda ours, measured: float(best_delay(ours, measured, most))


def rms_but_delay(most: float) -> Of:
    """Like rms(), after that delay. [%]"""
    return lambda ours, measured: rms()(ours, later(measured, best_delay(ours, measured, most)))


def slope(low: float, high: float) -> Of:
    """Mean slope over that of the measured curve, less 1. [%]"""

    def of(ours: Points, measured: Points) -> float:
        points = shared(ours, measured).between(low, high)
        own = np.polyfit(points.x, np.interp(points.x, ours.x, ours.y), 1)[0]
        return 100 * (own / np.polyfit(points.x, points.y, 1)[0] - 1)

    return of


def arrival(threshold: float) -> Of:
    """Where the curve first passes a threshold, later than the measured one, over its place. [%]"""

    def first(points: Points) -> float:
        above = np.nonzero(points.y > threshold)[0]
        return float(points.x[above[0]]) if len(above) else np.nan

    return lambda ours, measured: 100 * (first(ours) / first(measured) - 1)


def mean_of(points: Points) -> float:
    steps = np.diff(points.x)
    return float(steps @ (points.y[1:] + points.y[:-1]) / 2 / steps.sum())


def mean(low: float, high: float) -> Of:
    """Mean over a stretch over that of the measured curve, less 1. [%]"""

    def of(ours: Points, measured: Points) -> float:
        points = shared(ours, measured).between(low, high)
        return 100 * (mean_of(ours.between(low, high)) / mean_of(points) - 1)

    return of


def peak(low: float, high: float) -> Of:
    """Largest value over the largest of the measured curve, less 1. [%]"""
    return lambda ours, measured: 100 * (float(np.max(ours.between(low, high).y))
                                         / float(np.max(measured.between(low, high).y)) - 1)


def swing(low: float, high: float) -> Of:
    """Largest less smallest value over that of the measured curve, less 1. [%]"""
    return lambda ours, measured: 100 * (float(np.ptp(ours.between(low, high).y))
                                         / float(np.ptp(measured.between(low, high).y)) - 1)


def crests(low: float, high: float, least: float) -> Of:
    """Mean height of the crests above `least` over that of the measured curve, less 1. [%]"""

    def heights(points: Points) -> float:
        y = points.between(low, high).y
        tops, top = [], -np.inf
        for value in y:
            if value > least:
                top = max(top, value)
            elif top > least and value < 0:
                tops.append(top)
                top = -np.inf
        return float(np.mean(tops)) if tops else np.nan

    return lambda ours, measured: 100 * (heights(ours) / heights(measured) - 1)
