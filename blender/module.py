# SPDX-License-Identifier: GPL-3.0-or-later
"""The module hairloom, if it is there and of this version."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any


class Problem(Exception):
    """Something that the user can mend. The message says what is wrong and what is expected."""


def wanted_version() -> str:
    import tomllib

    with open(Path(__file__).parent / "blender_manifest.toml", "rb") as file:
        return tomllib.load(file)["version"]


def problem() -> str | None:
    """Why the module cannot be used; None if it can."""
    # Blender leaves a wheel out in silence where it does not suit the platform or the version of Python.
    try:
        import hairloom as module
    except ImportError as error:
        return f"The Python module hairloom cannot be loaded ({error}): it needs Linux on x86-64 and glibc 2.35 or later"
    from importlib import metadata

    try:
        found = metadata.version("hairloom")
    except metadata.PackageNotFoundError:
        found = "unknown"
    if found != wanted_version() or not hasattr(module, "LiveSimulation"):
        return f"The Python module hairloom has the version {found}: expected {wanted_version()}, of this extension"
    return _let_programs_run(Path(module.__file__).parent / "bin")


def _let_programs_run(folder: Path) -> str | None:
    """Blender unpacks wheels without the permission to run what is in them, and pip with it."""
    for program in folder.glob("hairloom-*"):
        if os.access(program, os.X_OK):
            continue
        try:
            program.chmod(0o755)
        except OSError as error:
            return f"{program} may not be run, and this cannot be changed: {error.strerror}"
    return None


class _Module:
    """hairloom, loaded when it is first used: Blender starts no later for it."""

    def __getattr__(self, name: str) -> Any:
        if wrong := problem():
            raise Problem(wrong)
        import hairloom as module

        self.__dict__.update({key: getattr(module, key) for key in module.__all__})
        return getattr(module, name)


hairloom: Any = _Module()
