# SPDX-License-Identifier: GPL-3.0-or-later
"""The window beside a script."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from ._core import Groom
from .errors import Error

if TYPE_CHECKING:
    import subprocess


def show(groom: Groom | str | os.PathLike[str], *, wait: bool = False) -> subprocess.Popen[bytes]:
    """Opens a groom, or a file, in the window of Hairloom beside the script.

    The window is a program of its own (`hairloom`), which this package does not bring. The environment variable
    HAIRLOOM_WINDOW names it if it is not in PATH. A groom is shown as it is now, as a project in the folder for
    temporary files. wait: returns when the window closes.

    Raises Error where there is no such program.
    """
    import shutil
    import subprocess
    import tempfile

    program = os.environ.get("HAIRLOOM_WINDOW") or shutil.which("hairloom")
    if not program or not Path(program).exists():
        raise Error(
            program or "hairloom",
            None,
            "is not there",
            "expected the window's program in PATH, or its name in HAIRLOOM_WINDOW",
        )
    if isinstance(groom, Groom):
        path = os.path.join(tempfile.mkdtemp(prefix="hairloom-show-"), "groom.hairloom")
        groom.save(path)
    else:
        path = os.fspath(groom)
    window = subprocess.Popen([program, path])
    if wait:
        window.wait()
    return window
