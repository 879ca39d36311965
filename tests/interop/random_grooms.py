# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes odd USD stages at random and has the same judges as odd_grooms.py look at them in every format: names with slashes,
spaces and letters of other scripts, names that become alike once they are legal, layers without strands, values of a wrong
length, layers that move at rates of their own, widths that one part lacks, ids that repeat. What moves is compared with
usd-core frame by frame, and cards of some are read as glTF."""
import argparse
import json
import os
import random
import struct
import sys

from pxr import Gf, Sdf, Tf, Usd, UsdGeom

import odd_grooms
from odd_grooms import blenders, check, run, shown

TOLERANCE = 2e-6  # m
RATE = 48
DISPLAYED = ("Hair/left", "Hair left", "Hair.left", "Hair_left", "頭", "首", "Brows (l)", "ß", "Ω", "a:b", "..", "0", "hair",
             "Hair", "'", '"quoted"', "tab\tname", "x" * 200, "🙂", "groom", "materials", "scalp", "guides", "%d", "C:\\hair")
KINDS = (("float", Sdf.ValueTypeNames.FloatArray, lambda rng: rng.uniform(-2, 2)),
         ("int", Sdf.ValueTypeNames.IntArray, lambda rng: rng.randint(-5, 5)),
         ("color", Sdf.ValueTypeNames.Color3fArray, lambda rng: Gf.Vec3f(rng.random(), rng.random(), rng.random())),
         ("half", Sdf.ValueTypeNames.HalfArray, lambda rng: rng.choice((0.5, 0.25, 1.5))),
         ("double", Sdf.ValueTypeNames.DoubleArray, lambda rng: rng.uniform(-1, 1)),
         ("float2", Sdf.ValueTypeNames.TexCoord2fArray, lambda rng: Gf.Vec2f(rng.random(), rng.random())))
ATTRIBUTES = ("groom_id", "groom_width", "groom_color", "groom_guide", "groom_group_id", "groom_root_uv", "a:b", "a_b", "a__b",
              "layer", "radius", "position", "id", "st", "velocity", "user:thing", "points_", "n0", "width")


def part(made, rng, path, moves):
    strands = rng.choice((0, 1, 1, 2, 3, 5))
    counts = [rng.choice((2, 3, 4, 9)) for _ in range(strands)]
    prim = UsdGeom.BasisCurves.Define(made, path)
    prim.CreateTypeAttr("linear")
    where = rng.uniform(-0.2, 0.2)
    points = [Gf.Vec3f(where + 0.01 * s, 1.5 + 0.03 * p, rng.uniform(-0.01, 0.01)) for s, n in enumerate(counts) for p in range(n)]
    prim.CreatePointsAttr(points)
    prim.CreateCurveVertexCountsAttr(counts)
    if rng.random() < 0.7:
        how = rng.choice(("constant", "uniform", "vertex"))
        number = {"constant": 1, "uniform": strands, "vertex": len(points)}[how]
        prim.CreateWidthsAttr([rng.choice((0.00005, 0.0001, 0.0)) if how != "constant" else 0.0001 for _ in range(number)])
        prim.SetWidthsInterpolation(how)
    if rng.random() < 0.8:
        prim.GetPrim().SetDisplayName(rng.choice(DISPLAYED))
    for name in rng.sample(ATTRIBUTES, rng.randint(0, 5)):
        kind, type_, value = rng.choice(KINDS)
        how = rng.choice(("constant", "uniform", "vertex"))
        number = {"constant": 1, "uniform": strands, "vertex": len(points)}[how]
        if rng.random() < 0.2:
            number = max(0, number + rng.choice((-1, 1, 7)))
        UsdGeom.PrimvarsAPI(prim).CreatePrimvar(name, type_, how).Set([value(rng) for _ in range(number)])
    if moves and strands and rng.random() < 0.7:
        codes = rng.choice(((0, 1, 2, 3, 4), (0, 2, 4), (0, 0.5, 1, 1.5, 2), (1, 4), (0, 1.5, 4)))
        for code in codes:
            prim.GetPointsAttr().Set([p + Gf.Vec3f(0, 0, 0.01 * code * (k % 3)) for k, p in enumerate(points)], code)
    return strands


def make(folder, number, rng):
    ext = rng.choice(("usda", "usdc"))
    name = f"random{number}.{ext}"
    unit = rng.choice((1.0, 1.0, 0.01))
    made = odd_grooms.stage(folder, name, 1.0)
    made.SetTimeCodesPerSecond(rng.choice((24, 30)))
    moves = number % 3 == 0
    above = ["/groom"] * 6
    if rng.random() < 0.3:
        above[3:] = ["/groom/inner"] * 3
    while sum(part(made, rng, f"{above[k]}/{rng.choice('pqh')}{k}_{Tf.MakeValidIdentifier(rng.choice(DISPLAYED))}", moves)
              for k in range(rng.randint(1, 6))) == 0:
        pass
    if unit != 1.0:
        root = UsdGeom.Xform.Define(made, "/groom")
        UsdGeom.XformCommonAPI(root).SetScale((1.5, 1.5, 1.5))
    if moves and rng.random() < 0.5:
        turn = UsdGeom.Xform.Define(made, "/groom").AddRotateYOp(opSuffix="turn")
        turn.Set(0.0, 0)
        turn.Set(30.0, 4)
    made.Save()
    return name


def positions(prims, code):
    cache = UsdGeom.XformCache(code)
    found = []
    for prim in prims:
        where = cache.GetLocalToWorldTransform(prim)
        found += [where.Transform(Gf.Vec3d(p)) for p in UsdGeom.PointBased(prim).GetPointsAttr().Get(code) or []]
    return found


def compare_motion(cli, folder, name):
    """Layers that move at rates of their own, at each frame of a record at a rate of its own."""
    path = os.path.join(folder, name)
    made, prims = shown(path)
    prims = [prim for prim in prims if UsdGeom.Curves(prim).GetCurveVertexCountsAttr().Get()]
    codes = set()
    for prim in prims:
        codes.update(UsdGeom.PointBased(prim).GetPointsAttr().GetTimeSamples())
    root = made.GetPrimAtPath("/groom")
    for op in UsdGeom.Xformable(root).GetOrderedXformOps() if root else []:
        codes.update(op.GetTimeSamples())
    if len(codes) < 2:
        return
    record, project = path + ".record", path + ".record.hairloom"
    came = run(cli, "import", path, "-o", project, "--record", record, "--fps", str(RATE), "--force")
    rate, start = made.GetTimeCodesPerSecond(), min(codes)
    for form in ("usdc", "abc"):
        out = f"{path}.record.{form}"
        run(cli, "export", project, "--format", form, "-o", out, "--record", record, "--frames", f"0,{came['frames'] - 1}", "--force")
        if form == "usdc":
            _, written = shown(out)
            times = sorted(UsdGeom.PointBased(written[0]).GetPointsAttr().GetTimeSamples())
            frames = [positions(written, code) for code in times]
        else:
            objects = odd_grooms.alembic_judge.curves_of(out)
            frames = [[Gf.Vec3d(*p) for one in objects for p in one["frames"][f]] for f in range(came["frames"])]
        for index, ours in enumerate(frames):
            theirs = positions(prims, start + index * rate / RATE)
            if len(ours) != len(theirs):
                raise ValueError(f"{form}: {len(ours)} points of {len(theirs)} in frame {index}")
            # Layers of one name are one: points may come in another order.
            key = lambda p: tuple(round(c, 5) for c in p)
            farthest = max((a - b).GetLength() for a, b in zip(sorted(ours, key=key), sorted(theirs, key=key)))
            if farthest > max(TOLERANCE, 1.5e-5):
                raise ValueError(f"{form}: a point is {farthest:g} m off in frame {index}")


def check_cards(cli, folder, name):
    project, out = os.path.join(folder, name + ".hairloom"), os.path.join(folder, name + ".glb")
    run(cli, "export", project, "--format", "gltf", "--levels", "cards:2@32", "--atlas", "64", "-o", out, "--force")
    with open(out, "rb") as file:
        data = file.read()
    length = struct.unpack("<I", data[12:16])[0]
    document = json.loads(data[20:20 + length].decode("utf-8"))
    if not document["meshes"] or struct.unpack("<I", data[8:12])[0] != len(data):
        raise ValueError("glTF without meshes, or of another length than it says")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cli", required=True)
    parser.add_argument("--count", type=int, default=30)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--cards", type=int, default=3, help="stages of which cards are made")
    parser.add_argument("-o", "--output", required=True)
    asked = parser.parse_args()
    os.makedirs(asked.output, exist_ok=True)
    found, failed = blenders(), 0
    for number in range(asked.count):
        name = make(asked.output, number, random.Random(1000 * asked.seed + number))
        try:
            strands = check(asked.cli, asked.output, name, found)
            compare_motion(asked.cli, asked.output, name)
            if number < asked.cards and strands > 1:
                check_cards(asked.cli, asked.output, name)
        except (ValueError, KeyError) as problem:
            print(f"FAILED {name}: {problem}")
            failed += 1
    print(f"{asked.count} odd stages at random, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
