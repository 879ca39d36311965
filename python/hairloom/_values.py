# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of Python and NumPy as JSON, and back."""

from __future__ import annotations

import json
import os
from typing import Any

from .errors import ArgumentError


def _plain(value: Any) -> Any:
    """NumPy's arrays and numbers, and mappings and paths, as what JSON knows."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if hasattr(value, "keys"):
        return {key: value[key] for key in value.keys()}
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"has a value of type {type(value).__name__}")


def to_json(value: Any) -> str:
    try:
        return json.dumps(value, default=_plain, allow_nan=False)
    except (TypeError, ValueError, RecursionError) as error:
        raise ArgumentError(
            None, None, f"the value is not JSON ({error})", "expected numbers, texts, lists and dicts"
        ) from None


def from_json(text: str) -> Any:
    return json.loads(text)


def motion_file(motion: Any) -> str:
    """A temporary file with the keys of `motion`."""
    if not hasattr(motion, "keys"):
        raise ArgumentError(
            None,
            None,
            f"motion is {type(motion).__name__}",
            "expected a name, the name of a file, or a dict with 'keys'",
        )
    text = to_json(motion)
    import tempfile

    with tempfile.NamedTemporaryFile("w", suffix=".json", prefix="motion-", delete=False) as file:
        file.write(text)
    return file.name
