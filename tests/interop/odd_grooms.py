# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes USD stages of the odd kinds that people's files are full of, imports each with hairloom-cli, exports it again,
and has Pixar's usd-core open and traverse every file: the strands that the stage shows, each name once, each array as
long as its interpolation says, each number in range, an extent that holds the hair, layers under their names."""
import argparse
import json
import math
import os
import subprocess
import sys

from pxr import Gf, Sdf, Usd, UsdGeom

FORMATS = ("usda", "usdc")
CURVES = ("BasisCurves", "NurbsCurves", "HermiteCurves")


def stage(folder, name, unit=1.0):
    path = os.path.join(folder, name)
    if os.path.exists(path):
        os.remove(path)
    made = Usd.Stage.CreateNew(path)
    if unit:
        UsdGeom.SetStageMetersPerUnit(made, unit)
    UsdGeom.SetStageUpAxis(made, "Y")
    return made


def curves(made, path, strands, x=0.0, points=4):
    prim = UsdGeom.BasisCurves.Define(made, path)
    prim.CreateTypeAttr("linear")
    prim.CreatePointsAttr([Gf.Vec3f(x + 0.01 * s, 0.05 * p, 0) for s in range(strands) for p in range(points)])
    prim.CreateCurveVertexCountsAttr([points] * strands)
    prim.CreateWidthsAttr([0.0001])
    prim.SetWidthsInterpolation("constant")
    return prim


def primvar(prim, name, kind, interpolation, values):
    UsdGeom.PrimvarsAPI(prim).CreatePrimvar(name, kind, interpolation).Set(values)


def names(folder, ext):
    made = stage(folder, f"names.{ext}")
    prim = curves(made, "/hair", 2)
    for name in ("bone_weight_Hair_L", "bone_weight_Hair_L_2", "a:b", "a_b", "normals", "colour", "guide", "layer"):
        primvar(prim, name, Sdf.ValueTypeNames.FloatArray, "uniform", [1.0, 2.0])
    primvar(prim, "rest", Sdf.ValueTypeNames.Point3fArray, "vertex", [Gf.Vec3f(i, 0, 0) for i in range(8)])
    made.Save()


def ids(folder, ext):
    made = stage(folder, f"ids.{ext}")
    for k, first in enumerate((0, 0, -1)):
        prim = curves(made, f"/part{k}", 3, x=k)
        primvar(prim, "groom_id", Sdf.ValueTypeNames.IntArray, "uniform", [first, first + 1, first + 2])
    made.Save()


def wide_ids(folder, ext):
    made = stage(folder, f"wide_ids.{ext}")
    for k in range(2):
        prim = curves(made, f"/part{k}", 2, x=k)
        primvar(prim, "groom_id", Sdf.ValueTypeNames.Int64Array, "uniform", [2**53 + 1 + 2 * k, 2**53 + 2 + 2 * k])
    made.Save()


def colours(folder, ext):
    made = stage(folder, f"colours.{ext}", unit=0.01)
    prim = curves(made, "/hair", 3)
    primvar(prim, "displayColor", Sdf.ValueTypeNames.Color3fArray, "vertex", [Gf.Vec3f(0.3, 0.2, 0.1)] * 12)
    primvar(prim, "groom_color", Sdf.ValueTypeNames.Color3fArray, "uniform", [Gf.Vec3f(0.5, 0.4, 0.3)] * 3)
    primvar(prim, "groom_width", Sdf.ValueTypeNames.FloatArray, "uniform", [0.01] * 3)
    made.Save()


def layers(folder, ext):
    made = stage(folder, f"layers.{ext}")
    for k, name in enumerate(("scalp", "brows", "lashes")):
        curves(made, f"/groom/{name}", k + 1, x=k).GetPrim().SetDisplayName(("", "Brows (left)", "頭")[k])
    made.Save()


def moving(folder, ext):
    made = stage(folder, f"moving.{ext}")
    made.SetTimeCodesPerSecond(48)
    group = UsdGeom.Xform.Define(made, "/turns")
    turn = group.AddRotateYOp()
    turn.Set(0.0, 1)
    turn.Set(90.0, 13)
    curves(made, "/turns/hair", 2)
    made.Save()


def composed(folder, ext):
    inner = stage(folder, f"inner.{ext}")
    UsdGeom.Xform.Define(inner, "/groom")
    curves(inner, "/groom/hair", 3)
    inner.SetDefaultPrim(inner.GetPrimAtPath("/groom"))
    inner.Save()
    made = stage(folder, f"composed.{ext}")
    made.DefinePrim("/a").GetReferences().AddReference(f"./inner.{ext}")
    made.DefinePrim("/b").GetPayloads().AddPayload(f"./inner.{ext}")
    made.CreateClassPrim("/_class")
    curves(made, "/_class/hair", 2)
    for k in range(2):
        UsdGeom.Xform.Define(made, f"/c{k}").GetPrim().GetInherits().AddInherit("/_class")
    made.GetPrimAtPath("/c1").SetInstanceable(True)
    curves(made, "/off", 5).GetPrim().SetActive(False)
    UsdGeom.Imageable(curves(made, "/hidden", 5).GetPrim()).MakeInvisible()
    made.Save()


def variants(folder, ext):
    made = stage(folder, f"variants.{ext}")
    prim = UsdGeom.Xform.Define(made, "/groom").GetPrim()
    lod = prim.GetVariantSets().AddVariantSet("lod")
    for name, strands in (("low", 2), ("high", 7)):
        lod.AddVariant(name)
        lod.SetVariantSelection(name)
        with lod.GetVariantEditContext():
            curves(made, "/groom/hair", strands)
    lod.SetVariantSelection("low")
    made.Save()


STAGES = (names, ids, wide_ids, colours, layers, moving, composed, variants)


def shown(path):
    """Prims of curves that a stage shows, with instances."""
    made = Usd.Stage.Open(path)
    if made is None:
        raise ValueError("usd-core does not open it")
    found = [prim for prim in made.Traverse(Usd.TraverseInstanceProxies()) if prim.GetTypeName() in CURVES]
    return made, [p for p in found if UsdGeom.Imageable(p).ComputeVisibility() != "invisible"]


def strands_of(prims):
    return sum(len(UsdGeom.Curves(prim).GetCurveVertexCountsAttr().Get() or []) for prim in prims)


def finite(value):
    try:
        return all(finite(part) for part in value)
    except TypeError:
        return not isinstance(value, float) or math.isfinite(value)


def check_prim(prim):
    curve = UsdGeom.Curves(prim)
    points, counts = curve.GetPointsAttr().Get(), curve.GetCurveVertexCountsAttr().Get()
    if sum(counts) != len(points):
        raise ValueError(f"{prim.GetPath()}: {sum(counts)} points in counts, {len(points)} points")
    own = [attribute.GetName() for attribute in prim.GetAuthoredAttributes()]
    if len(own) != len(set(own)):
        raise ValueError(f"{prim.GetPath()}: a name stands twice")
    sizes = {"vertex": len(points), "uniform": len(counts), "constant": 1}
    for one in UsdGeom.PrimvarsAPI(prim).GetPrimvars():
        values = one.Get()
        if values is None:
            continue
        if len(values) != sizes.get(one.GetInterpolation(), len(values)):
            raise ValueError(f"{one.GetName()}: {len(values)} values, {one.GetInterpolation()}")
        if not finite(values):
            raise ValueError(f"{one.GetName()}: not finite")
    low, high = curve.GetExtentAttr().Get()
    half = max(curve.GetWidthsAttr().Get()) / 2
    for point in points:
        if any(point[k] - half < low[k] - 1e-4 or point[k] + half > high[k] + 1e-4 for k in range(3)):
            raise ValueError(f"{prim.GetPath()}: the extent does not hold the hair")


def run(cli, *words):
    done = subprocess.run([cli, *words, "--json"], capture_output=True, text=True)
    if done.returncode != 0:
        raise ValueError(f"{' '.join(words)}: {done.stderr.strip()[-300:]}")
    return json.loads(done.stdout)


def layers_of(cli, project):
    return sorted((layer["name"], layer["strands"]) for layer in run(cli, "layers", project)["layers"])


def check(cli, folder, name):
    path = os.path.join(folder, name)
    _, prims = shown(path)
    expected = strands_of(prims)
    project = os.path.join(folder, name + ".hairloom")
    imported = run(cli, "import", path, "-o", project, "--force")
    if imported["strands"] != expected:
        raise ValueError(f"{imported['strands']} strands came in, usd-core shows {expected}")
    own = layers_of(cli, project)
    for form in FORMATS:
        out = os.path.join(folder, f"{name}.out.{form}")
        run(cli, "export", project, "--format", form, "-o", out, "--force")
        _, written = shown(out)
        if strands_of(written) != expected:
            raise ValueError(f"{form}: {strands_of(written)} strands went out of {expected}")
        for prim in written:
            check_prim(prim)
        again = out + ".hairloom"
        run(cli, "import", out, "-o", again, "--force")
        if len(own) > 1 and layers_of(cli, again) != own:
            raise ValueError(f"{form}: layers {own} came back as {layers_of(cli, again)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cli", required=True)
    parser.add_argument("-o", "--output", required=True)
    asked = parser.parse_args()
    os.makedirs(asked.output, exist_ok=True)
    failed = 0
    for make in STAGES:
        for ext in FORMATS:
            make(asked.output, ext)
            name = f"{make.__name__}.{ext}"
            try:
                check(asked.cli, asked.output, name)
                print(f"{name}: as usd-core has it")
            except (ValueError, KeyError) as problem:
                print(f"FAILED {name}: {problem}")
                failed += 1
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
