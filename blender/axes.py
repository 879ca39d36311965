# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender has Z up, Hairloom has Y up: (x, y, z) of Blender is (x, z, -y), which loses no bit."""

from __future__ import annotations

from typing import Any

import numpy as np

TO_Y_UP = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]], np.float64)
TO_Z_UP = TO_Y_UP.T


def to_y_up(points: np.ndarray) -> np.ndarray:
    turned = np.empty((len(points), 3), np.float32)
    turned[:, 0] = points[:, 0]
    turned[:, 1] = points[:, 2]
    np.negative(points[:, 1], out=turned[:, 2])
    return turned


def to_z_up(points: np.ndarray) -> np.ndarray:
    turned = np.empty((len(points), 3), np.float32)
    turned[:, 0] = points[:, 0]
    np.negative(points[:, 2], out=turned[:, 1])
    turned[:, 2] = points[:, 1]
    return turned


def to_y_up_metres(matrix: Any, metres: float) -> np.ndarray:
    """A matrix (4 × 4) from a space of Blender's to the world, as one to metres and Y up. `metres`: of a unit of the scene."""
    m = np.array(matrix, np.float64)
    m[:3] = TO_Y_UP @ m[:3] * metres
    return m
