"""How still pictures show space."""

from __future__ import annotations

import numpy as np

from reporting.runs import Run


def project(run: Run, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Parallel projection of points in 3-D, seen from the front, a little from the right and above.

    Returns the place in the picture and the distance from the eye.
    """
    turn, tilt = np.radians(25), np.radians(22)
    rightward, upward = np.eye(3)[0 if run.up != 0 else 1], np.eye(3)[run.up]
    right, into, up = points @ rightward, points @ np.cross(upward, rightward), points @ upward
    across, away = np.cos(turn) * right + np.sin(turn) * into, np.cos(turn) * into - np.sin(turn) * right
    return np.column_stack([across, np.cos(tilt) * up + np.sin(tilt) * away]), np.cos(tilt) * away - np.sin(tilt) * up
