# SPDX-License-Identifier: GPL-3.0-or-later
"""Strands from Cem Yuksel's .hair files, as hairloom-cli exports them."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

_HAS_SEGMENTS, _HAS_POINTS = 1, 2


@dataclass
class Strands:
    """Points of all strands one after the other, root first; strand i has points[offsets[i]:offsets[i + 1]]."""

    offsets: np.ndarray
    points: np.ndarray

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def __getitem__(self, i: int) -> np.ndarray:
        return self.points[self.offsets[i] : self.offsets[i + 1]]

    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        return self.points.min(axis=0), self.points.max(axis=0)


def read_hair(path: Path) -> Strands:
    data = path.read_bytes()
    if data[:4] != b"HAIR":
        raise SystemExit(f"error: {path}: not a .hair file")
    strands, points, flags, segments = (int(v) for v in np.frombuffer(data, "<u4", 4, offset=4))
    if not flags & _HAS_POINTS:
        raise SystemExit(f"error: {path}: it holds no points")
    at = 128
    if flags & _HAS_SEGMENTS:
        counts = np.frombuffer(data, "<u2", strands, offset=at).astype(np.int64)
        at += 2 * strands
    else:
        counts = np.full(strands, segments, dtype=np.int64)
    offsets = np.concatenate([[0], np.cumsum(counts + 1)])
    if offsets[-1] != points:
        raise SystemExit(f"error: {path}: {offsets[-1]} points in its strands, {points} in its header")
    positions = np.frombuffer(data, "<f4", 3 * points, offset=at).reshape(-1, 3)
    return Strands(offsets, positions.astype(np.float64))
