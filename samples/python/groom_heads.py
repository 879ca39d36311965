# SPDX-License-Identifier: GPL-3.0-or-later
"""Puts one hairstyle on every head of a folder: a project, an export, an image and a row of a report for each.

    python groom_heads.py style.hairloom heads/ out/ --target abc

A head that fails is reported, and the others go on.
"""

from __future__ import annotations

import argparse
import csv
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import hairloom


def groom_head(style: Path, head: Path, out: Path, target: str) -> dict[str, object]:
    project = out / f"{head.stem}.hairloom"
    try:
        moved = hairloom.transfer(style, to=head, output=project, quiet=True)
        exported = hairloom.export(project, format=target, output=out / f"{head.stem}.{target}", quiet=True)  # type: ignore[arg-type]
        hairloom.render(project, output=out / f"{head.stem}.png", size="512x512")
    except hairloom.Error as error:
        return {"head": head.name, "error": str(error)}
    return {
        "head": head.name,
        "strands": moved.strands,
        "max_root_error_mm": moved.max_root_error_mm,
        "bytes": exported.bytes,
    }


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("style", type=Path)
    arguments.add_argument("heads", type=Path)
    arguments.add_argument("out", type=Path)
    arguments.add_argument("--target", default="abc", help="a format of hairloom-cli export")
    given = arguments.parse_args()
    given.out.mkdir(exist_ok=True)
    heads = sorted(path for path in given.heads.iterdir() if path.suffix in {".glb", ".fbx", ".obj", ".usd", ".usda"})
    # Jobs are programs of their own, so threads keep all cores busy.
    with ThreadPoolExecutor() as pool:
        rows = list(pool.map(lambda head: groom_head(given.style, head, given.out, given.target), heads))
    with open(given.out / "report.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, ["head", "strands", "max_root_error_mm", "bytes", "error"])
        writer.writeheader()
        writer.writerows(rows)
    failed = [row for row in rows if "error" in row]
    print(f"{len(rows) - len(failed)} of {len(rows)} heads")
    if failed:
        raise SystemExit("\n".join(f"{row['head']}: {row['error']}" for row in failed))


if __name__ == "__main__":
    main()
