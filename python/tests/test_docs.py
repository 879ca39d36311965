# SPDX-License-Identifier: GPL-3.0-or-later
"""Every example of docs/python.md and each recipe of samples/python runs."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

from support import BUST, InFolder

import hairloom

TOP = Path(__file__).parents[2]


def examples() -> list[tuple[int, str]]:
    """The Python blocks of the page with their line."""
    page = (TOP / "docs/python.md").read_text()
    return [(page[: block.start()].count("\n") + 1, block[1]) for block in re.finditer(r"```python\n(.*?)```", page, re.S)]


class Examples(InFolder):
    def test_the_page(self) -> None:
        found = examples()
        self.assertGreater(len(found), 8)
        self.create()
        Path("head.glb").write_bytes(BUST.read_bytes())
        # One after the other, as you read them.
        names: dict[str, object] = {}
        for line, code in found:
            exec(compile("\n" * line + code, "docs/python.md", "exec"), names)

    def run_recipe(self, name: str, *arguments: str) -> None:
        subprocess.run([sys.executable, str(TOP / "samples/python" / name), *arguments], check=True)

    def test_fifty_heads(self) -> None:
        Path("heads").mkdir()
        for number in range(2):
            Path(f"heads/head{number}.glb").write_bytes(BUST.read_bytes())
        self.create("style.hairloom")
        self.run_recipe("groom_heads.py", "style.hairloom", "heads", "out", "--target", "abc")
        made = {path.name for path in Path("out").iterdir()}
        self.assertLessEqual({"head0.abc", "head0.hairloom", "head0.png", "head1.abc", "report.csv"}, made)
        rows = Path("out/report.csv").read_text().splitlines()
        self.assertEqual(len(rows), 3)
        self.assertTrue(rows[1].startswith("head0.glb,60,"))

    def test_accuracy(self) -> None:
        self.create("style.hairloom", 20)
        self.run_recipe("accuracy_plot.py", "style.hairloom", "plot", "--frames", "6")
        self.assertTrue(Path("plot.csv").read_text().startswith("substeps,ms,error_mm\n"))

    def test_cards(self) -> None:
        groom = self.create("style.hairloom", 80)
        hairloom.export(groom, format="ply", output="scan.ply")
        self.run_recipe("strands_to_cards.py", "scan.ply", str(BUST), "cards.glb", "--cards", "20")
        self.assertEqual(Path("cards.glb").read_bytes()[:4], b"glTF")
