# SPDX-License-Identifier: GPL-3.0-or-later
"""Grooms and folders of the tests."""

from __future__ import annotations

import os
import tempfile
import unittest
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import hairloom

SAMPLES = Path(hairloom.__file__).parent / "share" / "hairloom" / "samples"
if not SAMPLES.exists():  # in a build folder, not installed
    SAMPLES = Path(__file__).parents[2] / "samples"
BUST = SAMPLES / "bust" / "bust.glb"


def rows(strands: int, points: int = 8) -> tuple[NDArray[np.float32], NDArray[np.uint32]]:
    """Straight strands beside each other, 1 cm a segment, as positions and offsets."""
    positions = np.zeros((strands, points, 3), np.float32)
    positions[:, :, 0] = np.arange(strands)[:, None] * 0.01
    positions[:, :, 1] = 1.7 - 0.01 * np.arange(points)
    return positions.reshape(-1, 3), (np.arange(strands + 1) * points).astype(np.uint32)


class InFolder(unittest.TestCase):
    """Each test runs in an empty folder."""

    def setUp(self) -> None:
        before = os.getcwd()
        folder = tempfile.TemporaryDirectory(prefix="hairloom-python-test-")
        os.chdir(folder.name)
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, before)

    def create(self, output: str = "hair.hairloom", count: int = 60) -> hairloom.Groom:
        """A groom on the sample head."""
        hairloom.create(mesh=BUST, scalp="material:scalp", count=count, length=0.15, points=8, output=output)
        return hairloom.Groom.open(output)
