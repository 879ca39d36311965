# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders a groom with hairloom-cli and with Mitsuba 3 from the same view file, under several lights, for blond, brown and
black hair, and reports how far they are apart. ./dev truth runs it; --help lists what can be chosen."""

import argparse
import json
import subprocess
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

import block
import judge
import near
import path_trace
from hair_file import Strands, read_hair

# Eumelanin of the three colours, and what a unit of it absorbs over one fibre radius (Chiang et al. 2016).
COLOURS = {"blond": 0.3, "brown": 1.3, "black": 8.0}
ABSORPTION = np.array([0.419, 0.697, 1.37])
HEADS = {"skin": [0.5, 0.35, 0.27], "black": [0.0, 0.0, 0.0]}
LIGHTS = ("key", "back", "side", "box")
ALL_ORDERS = 100
# Of a view file, without the colour.
HAIR = {
    "radius_m": 0.0002,
    "tip_scale": 0.3,
    "ior": 1.55,
    "beta_deg": [8.3, 4.2, 16.7],
    "alpha_deg": [-2.0, 1.0, 3.0],
    "azimuthal_roughness": 0.3,
}
# How ours follows light that other hairs have scattered.
WAYS = ("dual", "volume")


@dataclass
class Verdict:
    light: str
    colour: str
    head: str
    truth_ratio: float  # of all scattering by single, path-traced
    single: judge.Closeness
    dual: judge.Closeness
    volume: judge.Closeness
    flip: float  # of the volume


def view_of(strands: Strands, size: int) -> dict:
    """A camera before and to the right of the head; the whole of the hair in the picture."""
    low, high = strands.bounds()
    target = (low + high) / 2
    direction = np.array([0.42, 0.08, 0.9])
    direction /= np.linalg.norm(direction)
    distance = np.linalg.norm(high - low) / 2 / np.sin(np.radians(22 / 2))
    return {
        "camera": {
            "eye": (target + distance * direction).tolist(),
            "target": target.tolist(),
            "up": [0, 1, 0],
            "fov_y_deg": 22.0,
        },
        "size": [size, size],
        "hair": dict(HAIR),
    }


def light_of(name: str, view: dict) -> dict:
    """One of LIGHTS, with the irradiance pi in the middle of the hair: from the camera's side and above, from behind, from
    its right, and a soft box of 20 degrees."""
    eye, target = (np.array(view["camera"][key]) for key in ("eye", "target"))
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, [0, 1, 0])
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    ways = {"key": [0.5, 0.8, 0.6], "back": 0.3 * right + 0.5 * up + 0.8 * forward, "side": right + 0.15 * up}
    if name in ways:
        return {"type": "directional", "to_light": list(ways[name]), "irradiance": [np.pi] * 3}
    distance = 1.2
    side = 2 * distance * np.tan(np.radians(10))
    way = -0.8 * forward + 0.5 * up - 0.35 * right
    way /= np.linalg.norm(way)
    return {
        "type": "rectangle",
        "position": (target + distance * way).tolist(),
        "facing": (-way).tolist(),
        "width": side,
        "height": side,
        "radiance": [np.pi * distance**2 / side**2] * 3,
    }


# What is path-traced are the strands themselves, alike and of one absorption.
PLAIN = [
    "interpolation.followPerGuide=0",
    "material.radiusVariation=0",
    "material.colourVariation=0",
    "material.melaninVariation=0",
    "material.tipMelanin=1",
    "material.colourSource=melanin",
    "material.streakShare=0",
    "material.dyeStrength=0",
    "material.rootOpacity=1",
    "material.tipOpacity=1",
    "material.emission=0",
    "material.tubes=false",
]


class Ours:
    def __init__(self, cli: Path, folder: Path, mi):
        self.cli, self.folder, self.mi = cli, folder, mi

    def render(self, groom: Path, view: dict, name: str, scatter: str) -> np.ndarray:
        view_file = self.folder / f"{name}.view.json"
        view_file.write_text(json.dumps(view, indent=1))
        exr = self.folder / f"{name}.{scatter}.exr"
        command = [self.cli, "render", groom, "--view", view_file, "--shading", "marschner"]
        command += ["--scatter", scatter, "--shadow", "dom", "--exr", exr]
        command += ["-o", self.folder / f"{name}.{scatter}.png", "--force"]
        subprocess.run([str(c) for c in command], check=True, stdout=subprocess.DEVNULL)
        return np.array(self.mi.Bitmap(str(exr)))[..., :3].astype(np.float64)


def strands_of(args: argparse.Namespace) -> tuple[Strands, Path]:
    """Of the groom, and a project of it whose strands are all alike."""
    hair_file = args.out / "strands.hair"
    subprocess.run(
        [str(args.cli), "export", str(args.groom), "--format", "hair", "-o", str(hair_file), "--force"],
        check=True,
        stdout=subprocess.DEVNULL,
    )
    strands = read_hair(hair_file)
    plain = args.out / "plain.hairloom"
    subprocess.run(
        [str(args.cli), "set", str(args.groom), *PLAIN, "-o", str(plain), "--force"], check=True, stdout=subprocess.DEVNULL
    )
    return strands, plain


def compare(args: argparse.Namespace, ours: Ours, strands: Strands, plain: Path) -> list[Verdict]:
    view = json.loads(args.view.read_text()) if args.view else view_of(strands, args.size)
    if args.size:
        view["size"] = [args.size, args.size]
    lights = {"view": view["lights"]} if args.view else {name: [light_of(name, view)] for name in args.lights}
    hair = view["hair"]
    curves = path_trace.write_curves(strands, hair["radius_m"], hair["tip_scale"], args.out / "curves")
    verdicts = []
    for light, head in ((light, head) for light in lights for head in HEADS):
        view["lights"], view["head_albedo"] = lights[light], HEADS[head]
        rows: list[list[np.ndarray]] = [[], [], [], [], []]
        for colour, eumelanin in COLOURS.items():
            hair["sigma_a_per_radius"] = (eumelanin * ABSORPTION).tolist()
            scene = path_trace.TruthScene(ours.mi, view, eumelanin, args.head, curves)
            single, whole = (scene.render(depth, args.samples) for depth in (2, ALL_ORDERS))
            covered = scene.coverage()
            name = f"{light}_{head}_{colour}"
            our_single, *ours_of = (ours.render(plain, view, name, scatter) for scatter in ("single", *WAYS))
            verdicts.append(
                Verdict(
                    light,
                    colour,
                    head,
                    judge.mean_where(whole, covered) / judge.mean_where(single, covered),
                    judge.closeness(our_single, single, covered),
                    *(judge.closeness(image, whole, covered) for image in ours_of),
                    judge.flip(ours_of[-1], whole, args.exposure),
                )
            )
            for row, image in zip(rows, (single, our_single, whole, *ours_of)):
                row.append(image)
            print(table(verdicts[-1:]).splitlines()[-1], flush=True)
        judge.save_sheet(ours.mi, rows, args.exposure, args.out / f"sheet_{light}_{head}.png")
    return verdicts


def table(verdicts: list[Verdict]) -> str:
    """Each of ours as light in all hair, in dim and in bright parts by the truth's, and relative MSE."""
    lines = [
        "| light | hair, head | all / single | single | dual | volume | FLIP |",
        "|---|---|---|---|---|---|---|",
    ]

    def shown(c: judge.Closeness) -> str:
        return f"{c.mean:.2f}, {c.dim:.2f}, {c.bright:.2f}, {c.relative_mse:.2f}"

    for v in verdicts:
        lines.append(
            f"| {v.light} | {v.colour}, {v.head} | {v.truth_ratio:.2f} | {shown(v.single)} | {shown(v.dual)} | "
            f"{shown(v.volume)} | {v.flip:.3f} |"
        )
    return "\n".join(lines) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cli", type=Path, required=True, help="hairloom-cli")
    parser.add_argument("--groom", type=Path, required=True, help="project, at rest")
    parser.add_argument("--head", type=Path, required=True, help="its head as OBJ or PLY, in metres")
    parser.add_argument("--view", type=Path, help="view file; else a camera that fits the hair, and --lights")
    parser.add_argument("--lights", nargs="+", choices=LIGHTS, default=LIGHTS, help="from where light comes")
    parser.add_argument("--size", type=int, default=256, help="pixels along one side")
    parser.add_argument("--samples", type=int, default=128, help="paths a pixel, a multiple of 16")
    parser.add_argument("--seeds", type=int, default=4, help="blocks of fibres whose mean counts")
    parser.add_argument("--exposure", type=float, default=6.0, help="factor on the light that is shown and that FLIP sees")
    parser.add_argument("-o", "--out", type=Path, required=True, help="folder of results")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    ours = Ours(args.cli, args.out, path_trace.start())
    strands, plain = strands_of(args)
    hair = {**HAIR, "sigma_a_per_radius": (COLOURS["blond"] * ABSORPTION).tolist()}
    curves = path_trace.write_curves(strands, hair["radius_m"], hair["tip_scale"], args.out / "near_curves")
    nearby = near.compare(ours, plain, strands, args.head, curves, hair, COLOURS["blond"], args.samples, light_of)
    (args.out / "near.md").write_text(near.table(nearby))
    print(near.table(nearby), end="")
    verdicts = compare(args, ours, strands, plain)
    (args.out / "truth.json").write_text(json.dumps([asdict(v) for v in verdicts], indent=1) + "\n")
    (args.out / "truth.md").write_text(table(verdicts))
    print(table(verdicts), end="")
    bands = block.compare(ours, PLAIN, hair, COLOURS["blond"], args.seeds, args.samples)
    (args.out / "block.md").write_text(block.table(bands))
    print(block.table(bands), end="")


if __name__ == "__main__":
    main()
