# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of simulated hair in a file of NumPy's: float32 (frames, points, 3), in the object's own space."""

from __future__ import annotations

import os
from pathlib import Path

import bpy
import numpy as np

from . import convert
from .module import Problem

_open: dict[str, "Cache"] = {}


class Cache:
    def __init__(self, path: Path) -> None:
        try:
            self.frames = np.load(path, mmap_mode="r", allow_pickle=False)
        except FileNotFoundError:
            raise Problem(f"The cache {path} is not there: bake it again") from None
        except (OSError, ValueError, EOFError) as error:
            raise Problem(f"{path} is no cache: {error}") from None
        if self.frames.ndim != 3 or self.frames.shape[2] != 3 or self.frames.dtype != np.float32 or len(self.frames) == 0:
            raise Problem(f"{path} is no cache: it has {self.frames.dtype} {self.frames.shape}, expected float32 (frames, points, 3)")

    @classmethod
    def of(cls, obj: bpy.types.Object) -> Cache:
        path = bpy.path.abspath(obj.data.hairloom.cache)
        if path not in _open:
            _open[path] = cls(Path(path))
        return _open[path]

    def show(self, obj: bpy.types.Object, frame: int) -> None:
        """The first and last frames stand before and after them."""
        if self.frames.shape[1] != len(obj.data.points):
            raise Problem(f"The cache has {self.frames.shape[1]} points and the hair {len(obj.data.points)}: bake it again")
        index = min(max(frame - obj.data.hairloom.cache_start, 0), len(self.frames) - 1)
        convert.set_positions(obj.data, self.frames[index])
        obj.data.update_tag()

    @staticmethod
    def close_all() -> None:
        _open.clear()


class Writer:
    """Writes beside the file and replaces it when all is there, so that a failure leaves the old one."""

    def __init__(self, path: Path, frames: int, points: int) -> None:
        self.path, self.part = path, path.with_name(path.name + ".part")
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self.frames = np.lib.format.open_memmap(self.part, "w+", np.float32, (frames, points, 3))
            if hasattr(os, "posix_fallocate"):
                # A full disk is an error here, and not a signal when a frame is written.
                with open(self.part, "r+b") as file:
                    os.posix_fallocate(file.fileno(), 0, os.fstat(file.fileno()).st_size)
        except OSError as error:
            if path.parent.is_dir():
                self.part.unlink(missing_ok=True)
            raise Problem(f"{path} cannot be written: {error.strerror}") from None

    def add(self, index: int, obj: bpy.types.Object) -> None:
        self.frames[index] = convert.positions_of(obj.data)

    def finish(self) -> None:
        self.frames.flush()
        del self.frames
        os.replace(self.part, self.path)
        Cache.close_all()

    def discard(self) -> None:
        self.part.unlink(missing_ok=True)
