# SPDX-License-Identifier: GPL-3.0-or-later
"""Exceptions. Each says what is wrong, where, and what was expected."""

from __future__ import annotations


class Error(Exception):
    """A job or a call failed.

    file: the path as you gave it, or None.
    place: {"line": n} from 1, {"byte": n} from 0, or None.
    what: what is wrong, naming what was found.
    expected: what would have been right, or None.
    """

    def __init__(
        self, file: str | None, place: dict[str, int] | None, what: str, expected: str | None
    ) -> None:
        self.file = file
        self.place = place
        self.what = what
        self.expected = expected
        super().__init__(file, place, what, expected)

    def __str__(self) -> str:
        where = self.file or ""
        if self.place:
            (kind, number), *_ = self.place.items()
            where += f":{number}" if kind == "line" else f"@{number}"
        text = f"{where}: {self.what}" if where else self.what
        return f"{text}; {self.expected}" if self.expected else text


class ArgumentError(Error, ValueError):
    """An argument has the wrong type, shape, order in memory or value. Nothing was done."""


class BusyError(Error, RuntimeError):
    """Another thread is using this object. Nothing was done."""
