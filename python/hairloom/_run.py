# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a job of hairloom-cli, which is part of this package, and gives its report."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from ._core import Groom
from .errors import ArgumentError, Error

PROGRAM = Path(__file__).parent / "bin" / "hairloom-cli"


class Report(Mapping[str, Any]):
    """What a job answers. Keys are attributes, too: report["strands"] is report.strands.

    docs/cli.md lists the keys of each job. Objects inside are reports, and lists are lists.
    """

    def __init__(self, members: Mapping[str, Any]) -> None:
        self._members = {key: _typed(value) for key, value in members.items()}

    def __getitem__(self, key: str) -> Any:
        return self._members[key]

    def __getattr__(self, name: str) -> Any:
        try:
            return self.__dict__["_members"][name]
        except KeyError:
            raise AttributeError(f"the report has no '{name}'", name=name, obj=self) from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._members)

    def __len__(self) -> int:
        return len(self._members)

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self._members})

    def __repr__(self) -> str:
        return f"Report({self._members!r})"


def _typed(value: Any) -> Any:
    if isinstance(value, dict):
        return Report(value)
    return [_typed(item) for item in value] if isinstance(value, list) else value


def _text(value: Any, folder: list[str]) -> str:
    """A value as the command line has it. A Groom becomes a project in a temporary folder."""
    if isinstance(value, Groom):
        if not folder:
            import tempfile

            folder.append(tempfile.mkdtemp(prefix="hairloom-"))
        path = os.path.join(folder[0], f"groom{len(os.listdir(folder[0]))}.hairloom")
        value.save(path)
        return path
    if isinstance(value, (list, tuple)) or hasattr(value, "tolist"):
        items = value.tolist() if hasattr(value, "tolist") else value
        return ",".join(_text(item, folder) for item in items) if isinstance(items, (list, tuple)) else str(items)
    if isinstance(value, (bytes, os.PathLike)):
        return os.fsdecode(value)
    if isinstance(value, (str, int, float)):
        return str(value)
    raise ArgumentError(
        None, None, f"an argument is {type(value).__name__}", "expected a text, a file, a number, a Groom, or a list of these"
    )


def _arguments(
    options: Sequence[tuple[str, str | None, bool, bool]], values: Mapping[str, Any], folder: list[str]
) -> Iterator[str]:
    """The command line of these values. An option is its keyword, its argument, whether it is a flag, and
    whether it may stand several times. What stands by its place comes last, behind `--`."""
    placed: list[str] = []
    for keyword, argument, flag, many in options:
        value = values[keyword]
        if flag and hasattr(value, "tolist"):
            value = value.tolist()  # of NumPy
        if value is None or (flag and value is False):
            continue
        if flag:
            if value is not True:
                raise ArgumentError(None, None, f"{keyword} is {value!r}", "expected True or False")
            yield str(argument)
            continue
        several = many and isinstance(value, (list, tuple))
        texts = [_text(item, folder) for item in value] if several else [_text(value, folder)]
        if argument is None:
            placed += texts
        else:
            for text in texts:
                yield f"{argument}={text}"
    if placed:
        yield "--"
        yield from placed


def run(name: str, options: Sequence[tuple[str, str | None, bool, bool]], values: Mapping[str, Any]) -> Report:
    # Not above, where they would be half of the time that `import hairloom` takes.
    import json
    import logging
    import subprocess

    folder: list[str] = []
    try:
        command = [os.fspath(PROGRAM), name, "--json", *_arguments(options, values, folder)]
        try:
            done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, check=False)
        except OSError as error:
            raise Error(str(PROGRAM), None, f"cannot be started: {error.strerror}", "install the package anew") from None
        except ValueError as error:  # a null character, say
            raise ArgumentError(None, None, f"an argument cannot be passed on: {error}", None) from None
    finally:
        if folder:
            for file in os.listdir(folder[0]):
                os.unlink(os.path.join(folder[0], file))
            os.rmdir(folder[0])
    for line in done.stderr.decode(errors="replace").splitlines():
        if not line.startswith("error: "):  # which becomes an exception
            logging.getLogger("hairloom").warning("%s", line.removeprefix("warning: "))
    try:
        answer = json.loads(done.stdout)
    except ValueError:
        raise Error(None, None, f"{name} ended with status {done.returncode} and no report", None) from None
    if done.returncode == 0:
        return Report(answer)
    told = answer["error"]
    # Wrong usage has a status of its own.
    kind = ArgumentError if done.returncode == 2 else Error
    raise kind(told["file"], told["place"], told["what"], told["expected"])
