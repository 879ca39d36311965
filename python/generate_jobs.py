# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes hairloom/jobs.py: a function for each job of the command line, from `hairloom-cli reference --jobs`.

    generate_jobs.py JOBS.json JOBS.py
"""

from __future__ import annotations

import json
import keyword
import sys
import textwrap
from typing import Any

HEAD = '''# Written by python/generate_jobs.py from the registry of hairloom-cli. Do not edit it.
"""The jobs of the command line. Keywords are its options; docs/cli.md says what each answers."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Literal

from ._core import Groom
from ._run import Report, run

# A text, the name of a file, a Groom in place of one, or numbers that the command line separates by commas.
Value = str | os.PathLike[str] | Groom | Sequence[float] | Sequence[str]
'''
TYPES = {"INT": "int", "UINT": "int", "FLOAT": "float"}
# Of every job: how a program prints is no matter here.
LEFT_OUT = {"json", "version", "profile"}


def identifier(name: str) -> str:
    """import becomes import_, as everywhere in Python; pre-roll becomes pre_roll."""
    name = name.replace("-", "_")
    return name + "_" if keyword.iskeyword(name) else name


def type_of(option: dict[str, Any]) -> str:
    if option["type"] == "FLAG":
        return "bool"
    if option["choices"] and not option["many"]:
        quote = "" if option["type"] in TYPES else '"'
        one = "Literal[" + ", ".join(f"{quote}{choice}{quote}" for choice in option["choices"]) + "]"
    else:
        one = TYPES.get(option["type"], "Value")
    return f"{one} | Sequence[{one}]" if option["many"] and one in TYPES.values() else one


def function(job: dict[str, Any], common: list[dict[str, Any]]) -> tuple[str, str]:
    options = job["options"] + [option for option in common if option["name"] not in LEFT_OUT]
    placed = [option for option in options if option["argument"] is None]
    named = [option for option in options if option["argument"] is not None]
    parameters: list[str] = []
    table: list[str] = []
    words: list[str] = []

    def add(option: dict[str, Any]) -> None:
        name = identifier(option["name"])
        kind, flag = type_of(option), option["type"] == "FLAG"
        # An option that may be left out is None: its default is the program's own.
        default = "" if option["required"] else " = False" if flag else " = None"
        optional = "" if option["required"] or flag else " | None"
        parameters.append(f"    {name}: {kind}{optional}{default},")
        table.append(f"        ({name!r}, {option['argument']!r}, {flag}, {option['many']}),")
        lines = textwrap.wrap(f"{name}: {option['meaning']}", 100, subsequent_indent="    ", break_long_words=False)
        words.extend("    " + line for line in lines)

    for option in placed:
        add(option)
    if named:
        parameters.append("    *,")
    for option in named:
        add(option)
    name = identifier(job["name"])
    text = "\n".join(
        [
            f"def {name}(",
            *parameters,
            ") -> Report:",
            f'    r"""{job["does"]}.',
            "",
            f"    On the command line: {job['example']}",
            "",
            *words,
            "",
            "    Raises ArgumentError for wrong usage, and Error where the job fails.",
            '    """',
            "    values = locals()",
            f"    return run({job['name']!r}, _OPTIONS[{job['name']!r}], values)",
        ]
    )
    return text, f"    {job['name']!r}: [\n" + "\n".join(table) + "\n    ],"


def main(source: str, target: str) -> None:
    with open(source, encoding="utf-8") as file:
        described = json.load(file)
    functions, tables = zip(*(function(job, described["options"]) for job in described["jobs"]))
    names = [identifier(job["name"]) for job in described["jobs"]]
    with open(target, "w", encoding="utf-8") as file:
        file.write(HEAD)
        file.write("__all__ = [\n" + "".join(f'    "{name}",\n' for name in names) + "]\n")
        file.write("_OPTIONS: dict[str, list[tuple[str, str | None, bool, bool]]] = {\n" + "\n".join(tables) + "\n}\n\n\n")
        file.write("\n\n\n".join(functions) + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
