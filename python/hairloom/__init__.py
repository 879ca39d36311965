# SPDX-License-Identifier: GPL-3.0-or-later
"""Hairloom in Python: hairstyles for games and film as NumPy arrays, and every job of the command line.

`Groom` opens, edits, simulates and draws a hairstyle. `Engine` is the strand engine alone. The functions are the
jobs of `hairloom-cli`, with an option as a keyword each. Lengths are in metres, time in seconds, Y is up.
"""

from __future__ import annotations

import os as _os
from pathlib import Path as _Path

# Files of others are read in a confined process of its own, which lies beside the command line.
_os.environ.setdefault("HAIRLOOM_MESH_READER", str(_Path(__file__).parent / "bin" / "hairloom-mesh-reader"))

from . import jobs as _jobs
from ._core import Attributes, Engine, Frame, Groom, LiveSimulation, Simulation
from ._run import Report
from ._show import show
from .errors import ArgumentError, BusyError, Error
from .jobs import *

__all__ = [
    "ArgumentError",
    "Attributes",
    "BusyError",
    "Engine",
    "Error",
    "Frame",
    "Groom",
    "LiveSimulation",
    "Report",
    "Simulation",
    "show",
    *_jobs.__all__,
]
