"""Which row of the page a particle has. With openings particles come and go; a row serves one after the other."""

from __future__ import annotations

import numpy as np


class Rows:
    """Rows by frame: a particle keeps its own as long as it is there."""

    def __init__(self) -> None:
        self.count = 0  # so far
        self._ids = self._rows = np.empty(0, int)  # of the last frame

    def of(self, ids: np.ndarray) -> np.ndarray:
        """The rows of the next frame's particles, whose ids are all different."""
        _, stays, before = np.intersect1d(ids, self._ids, assume_unique=True, return_indices=True)
        rows = np.full(len(ids), -1)
        rows[stays] = self._rows[before]
        come = np.flatnonzero(rows < 0)
        # A row stays empty for a frame at least: the page sees from "empty" alone that somebody comes or has gone.
        free = np.setdiff1d(np.arange(self.count), self._rows)[:len(come)]
        rows[come] = np.concatenate([free, self.count + np.arange(len(come) - len(free))])
        self.count += len(come) - len(free)
        self._ids, self._rows = ids, rows
        return rows


def stays_of(ids: np.ndarray) -> list[np.ndarray]:
    """Columns row, first frame, last frame, id of all stays; `ids` is frames x rows, -1 where nobody is."""
    nobody = np.full((1, ids.shape[1]), -1)
    changes = np.concatenate([nobody, ids, nobody])
    changes = (changes[1:] != changes[:-1]).T
    there = ids.T >= 0
    rows, first = np.nonzero(changes[:, :-1] & there)
    return [rows, first, np.nonzero(changes[:, 1:] & there)[1], ids[first, rows]]
