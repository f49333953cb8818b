"""Numbers on their way into the page: fewer bits, differences in time, deflate, base64.

page/data.js undoes this. Nothing here knows what the numbers mean.
"""

from __future__ import annotations

import base64
import zlib
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Packed:
    """Numbers as whole steps of a range: low + code * (high - low) / (2^bits - 1), code in 0 ... 2^bits - 1."""

    low: float
    high: float
    bits: int
    text: str  # base64

    @property
    def step(self) -> float:
        """Between two neighbouring codes; a number is off by half of it at most, unless it lies outside the range."""
        return (self.high - self.low) / (2**self.bits - 1)


def pack_frames(values: np.ndarray, low: float, high: float, bits: int, order: int) -> Packed:
    """Values by frame, frames x rows, of at most 16 bits each; those outside low ... high become its ends.

    `order` differences in time come before deflate: 2 for what moves evenly, 1 for what changes, 0 for one frame.
    """
    largest = 2**bits - 1
    scale = largest / (high - low) if high > low else 0.0
    finite = np.nan_to_num(values, nan=low, posinf=high, neginf=low)
    codes = np.rint((np.clip(finite, low, high) - low) * scale).astype(np.uint16)
    for _ in range(order):
        codes[1:] -= codes[:-1].copy()
    # Small differences of either sign become small numbers, whose high bytes are mostly 0.
    folded = (codes << np.uint16(1)) ^ (np.uint16(0) - (codes >> np.uint16(15)))
    return Packed(low, high, bits, deflated(byte_planes(folded.astype("<u2"))))


def pack_table(columns: list[np.ndarray]) -> str:
    """Columns of equal length, one after the other, as 8-byte floats; base64."""
    return deflated(byte_planes(np.array(columns, "<f8")))


def byte_planes(values: np.ndarray) -> bytes:
    """The first bytes of all numbers, then the second ones, ...: alike bytes stand together."""
    return np.ascontiguousarray(values).view(np.uint8).reshape(-1, values.itemsize).T.tobytes()


def deflated(content: bytes) -> str:
    return base64.b64encode(zlib.compress(content, 6)).decode()
