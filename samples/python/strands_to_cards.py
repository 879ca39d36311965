# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes cards for a game from reconstructed strands: cleans them, binds them to the head, writes glTF.

    python strands_to_cards.py scan.ply head.glb cards.glb --cards 200
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import numpy as np

import hairloom


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("strands")
    arguments.add_argument("head")
    arguments.add_argument("output")
    arguments.add_argument("--cards", type=int, default=200)
    given = arguments.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        project = Path(folder) / "hair.hairloom"
        found = hairloom.import_(given.strands, mesh=given.head, scalp="material:scalp", clean=True, output=project)
        print(f"{found.strands} strands")
        groom = hairloom.Groom.open(project)
    # Reconstructions are rough: smooth them, and leave out what is shorter than 2 cm.
    groom.apply("smooth")
    starts = groom.offsets
    segments = np.linalg.norm(np.diff(groom.positions, axis=0), axis=1)
    lengths = np.array([segments[a : b - 1].sum() for a, b in zip(starts[:-1], starts[1:])])
    short = np.flatnonzero(lengths < 0.02)
    if len(short):
        runs = [number for strand in short for number in (int(strand), 1)]
        groom.apply("strands", do="delete", strands=runs)
    report = hairloom.export(groom, format="gltf", cards=given.cards, output=given.output)
    print(f"{report.bytes} bytes in {given.output}")


if __name__ == "__main__":
    main()
