# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes USD stages of the odd kinds that people's files are full of, imports each with hairloom-cli, exports it again,
and has Pixar's usd-core, the Alembic library and Blender open and traverse every file: the strands that the stage
shows, each name once, each array as long as its interpolation says, each number in range, an extent that holds the hair,
widths, layers under their names, and motion at its times."""
import argparse
import json
import math
import os
import re
import subprocess
import sys

from pxr import Gf, Sdf, Usd, UsdGeom

import alembic_judge
import plain_readers

FORMATS = ("usda", "usdc")
BY_BLENDER = ("usdc", "abc", "obj-lines")
OTHERS = ("hair", "tfx", "ply", "obj-c4d")
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
    """Attributes whose names have a meaning, or are not legal."""
    made = stage(folder, f"names.{ext}")
    prim = curves(made, "/hair", 2)
    for name in ("bone_weight_Hair_L", "bone_weight_Hair_L_2", "a:b", "a_b", "normals", "colour", "guide", "layer"):
        primvar(prim, name, Sdf.ValueTypeNames.FloatArray, "uniform", [1.0, 2.0])
    primvar(prim, "rest", Sdf.ValueTypeNames.Point3fArray, "vertex", [Gf.Vec3f(i, 0, 0) for i in range(8)])
    made.Save()


def alike(folder, ext):
    """Layers, attributes and bones whose names become alike once they are legal, without UVs."""
    made = stage(folder, f"alike.{ext}")
    for k, (name, shown_as) in enumerate((("_", "頭"), ("__2", "首"), ("Hair_L", "Hair.L"), ("Hair_L_2", "Hair_L"))):
        prim = curves(made, f"/groom/{name}", k + 1, x=k)
        prim.GetPrim().SetDisplayName(shown_as)
        for number, (attribute, original) in enumerate((("bone_weight__", "bone_weight_頭"), ("bone_weight___2", "bone_weight_首"),
                                                        ("bone_weight_Hair_L", "bone_weight_Hair.L"))):
            one = UsdGeom.PrimvarsAPI(prim).CreatePrimvar(attribute, Sdf.ValueTypeNames.FloatArray, "uniform")
            one.Set([0.25 * number] * (k + 1))
            one.GetAttr().SetDisplayName(original)
    made.Save()


def ids(folder, ext):
    """Ids that repeat, and are -1."""
    made = stage(folder, f"ids.{ext}")
    for k, first in enumerate((0, 0, -1)):
        prim = curves(made, f"/part{k}", 3, x=k)
        primvar(prim, "groom_id", Sdf.ValueTypeNames.IntArray, "uniform", [first, first + 1, first + 2])
    made.Save()


def wide_ids(folder, ext):
    """Ids of 64 bits."""
    made = stage(folder, f"wide_ids.{ext}")
    for k in range(2):
        prim = curves(made, f"/part{k}", 2, x=k)
        primvar(prim, "groom_id", Sdf.ValueTypeNames.Int64Array, "uniform", [2**53 + 1 + 2 * k, 2**53 + 2 + 2 * k])
    made.Save()


def colours(folder, ext):
    """Colours and widths under two names, in centimetres."""
    made = stage(folder, f"colours.{ext}", unit=0.01)
    prim = curves(made, "/hair", 3)
    primvar(prim, "displayColor", Sdf.ValueTypeNames.Color3fArray, "vertex", [Gf.Vec3f(0.3, 0.2, 0.1)] * 12)
    primvar(prim, "groom_color", Sdf.ValueTypeNames.Color3fArray, "uniform", [Gf.Vec3f(0.5, 0.4, 0.3)] * 3)
    primvar(prim, "groom_width", Sdf.ValueTypeNames.FloatArray, "uniform", [0.01] * 3)
    made.Save()


def layers(folder, ext):
    """Layers, with names that no format takes as they are."""
    made = stage(folder, f"layers.{ext}")
    for k, name in enumerate(("scalp", "brows", "lashes")):
        curves(made, f"/groom/{name}", k + 1, x=k).GetPrim().SetDisplayName(("", "Brows (left)", "頭")[k])
    made.Save()


def moving(folder, ext):
    """Hair that moves, with and without a shutter."""
    made = stage(folder, f"moving.{ext}")
    made.SetTimeCodesPerSecond(48)
    group = UsdGeom.Xform.Define(made, "/turns")
    turn = group.AddRotateYOp()
    turn.Set(0.0, 1)
    turn.Set(90.0, 13)
    curves(made, "/turns/hair", 2, x=0.1)
    made.Save()


def composed(folder, ext):
    """References, payloads, classes, instances, and what is hidden or not active."""
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
    """Variants in variants."""
    made = stage(folder, f"variants.{ext}")
    prim = UsdGeom.Xform.Define(made, "/groom").GetPrim()
    style, lod = (prim.GetVariantSets().AddVariantSet(name) for name in ("style", "lod"))
    for k, name in enumerate(("bob", "long")):
        style.AddVariant(name)
        style.SetVariantSelection(name)
        with style.GetVariantEditContext():
            for level, strands in (("low", 2), ("high", 7)):
                lod.AddVariant(level)
                lod.SetVariantSelection(level)
                with lod.GetVariantEditContext():
                    curves(made, "/groom/hair", strands + 10 * k)
            lod.SetVariantSelection("low")
    made.Save()


def copied(folder, ext):
    """Copies by a PointInstancer, some of which are hidden or not active."""
    made = stage(folder, f"copied.{ext}")
    instancer = UsdGeom.PointInstancer.Define(made, "/copies")
    for k in range(2):
        curves(made, f"/copies/kinds/k{k}", 2 + k)
    instancer.CreatePrototypesRel().SetTargets(["/copies/kinds/k0", "/copies/kinds/k1"])
    instancer.CreateProtoIndicesAttr([0, 1, 0, 1, 0])
    instancer.CreatePositionsAttr([Gf.Vec3f(0.3 * k, 0, 0) for k in range(5)])
    instancer.CreateIdsAttr([10, 20, 30, 40, 2**40])
    instancer.DeactivateId(20)
    instancer.InvisId(2**40, Usd.TimeCode.Default())
    made.Save()


def empty(folder, ext):
    """Parts without strands, and values that there are not."""
    made = stage(folder, f"empty.{ext}")
    primvar(curves(made, "/full", 2), "tint", Sdf.ValueTypeNames.FloatArray, "uniform", [0.5, 0.25])
    bare = curves(made, "/bare", 3, x=1)
    primvar(bare, "nothing", Sdf.ValueTypeNames.FloatArray, "uniform", [])
    UsdGeom.PrimvarsAPI(bare).CreatePrimvar("blocked", Sdf.ValueTypeNames.FloatArray, "uniform").GetAttr().Block()
    none = UsdGeom.BasisCurves.Define(made, "/none")
    none.CreatePointsAttr([])
    none.CreateCurveVertexCountsAttr([])
    made.Save()


STAGES = (names, alike, ids, wide_ids, colours, layers, moving, composed, copied, variants, empty)


def shown(path):
    """Prims of curves that a stage shows, with instances."""
    made = Usd.Stage.Open(path)
    if made is None:
        raise ValueError("usd-core does not open it")
    found = [prim for prim in made.Traverse(Usd.TraverseInstanceProxies())
             if prim.GetTypeName() in CURVES and not instancer_of(prim)]
    return made, [p for p in found if UsdGeom.Imageable(p).ComputeVisibility() != "invisible"]


def instancer_of(prim):
    """The PointInstancer that a prim lies below, whose prototypes are not shown where they stand."""
    while prim and not prim.IsA(UsdGeom.PointInstancer):
        prim = prim.GetParent()
    return prim


def copied_strands(made):
    """Strands of all copies that PointInstancers make."""
    strands = 0
    for prim in made.Traverse():
        if not prim.IsA(UsdGeom.PointInstancer):
            continue
        instancer = UsdGeom.PointInstancer(prim)
        kinds = [strands_of([one for one in Usd.PrimRange(made.GetPrimAtPath(path)) if one.GetTypeName() in CURVES])
                 for path in instancer.GetPrototypesRel().GetTargets()]
        indices = instancer.GetProtoIndicesAttr().Get()
        mask = instancer.ComputeMaskAtTime(Usd.TimeCode.Default()) or [True] * len(indices)
        strands += sum(kinds[index] for index, seen in zip(indices, mask) if seen)
    return strands


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
        raise ValueError(f"{prim.GetPath()}: a name appears twice")
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


def blenders():
    """Pythons that have Blender's module bpy: those that HAIRLOOM_BLENDERS names, else this one if it does."""
    named = os.environ.get("HAIRLOOM_BLENDERS", "").split()
    asked = named or [sys.executable]
    return [one for one in asked if subprocess.run([one, "-c", "import bpy"], capture_output=True).returncode == 0]


def version_of(blender):
    done = subprocess.run([blender, "-c", "import bpy; print('VERSION', bpy.app.version_string)"], capture_output=True, text=True)
    return next(line.split()[1] for line in done.stdout.splitlines() if line.startswith("VERSION"))


def blender_objects(path, blender, *more):
    """What Blender has of a file: an object each."""
    judge = os.path.join(os.path.dirname(__file__), "blender_judge.py")
    done = subprocess.run([blender, judge, path, *more], capture_output=True, text=True)
    lines = [line for line in done.stdout.splitlines() if line.startswith("OBJECTS")]
    if not lines:
        raise ValueError(f"Blender ended with {done.returncode}: {done.stderr.strip()[-200:]}")
    return json.loads(lines[0][len("OBJECTS"):])


def legal(name):
    """As Blender's names of objects that come from other programs may differ from layers': letters alone."""
    return "".join(c for c in name if c.isascii() and c.isalnum()).lower()


def check_alembic(path, expected, own):
    objects = alembic_judge.curves_of(path)
    for one in objects:
        alembic_judge.check(one)
    strands = sum(len(one["counts"]) for one in objects)
    if strands != expected:
        raise ValueError(f"abc: {strands} strands went out of {expected}")
    names = sorted((one["group"] or one["path"].split("/")[2], len(one["counts"])) for one in objects)
    if len(own) > 1 and names != own:
        raise ValueError(f"abc: layers {own} went out as {names}")


def check_motion(cli, folder, project, name):
    """A record that came in goes out with its times, in both formats that move."""
    record = os.path.join(folder, name + ".frames")
    came = run(cli, "import", os.path.join(folder, name), "-o", project, "--record", record, "--fps", "24", "--force")
    last = came["frames"] - 1
    rate = came["fps"]
    for form in ("abc", "usda", "usdc"):
        out = os.path.join(folder, f"{name}.moving.{form}")
        run(cli, "export", project, "--format", form, "-o", out, "--record", record, "--frames", f"0,{last}", "--force")
        if form == "abc":
            for one in alembic_judge.curves_of(out):
                alembic_judge.check(one)
                times, moved = one["times"], one["velocities"]
                points = one["frames"]
        else:
            made, prims = shown(out)
            curve = UsdGeom.Curves(prims[0])
            codes = curve.GetPointsAttr().GetTimeSamples()
            times = [code / made.GetTimeCodesPerSecond() for code in codes]
            points = [curve.GetPointsAttr().Get(code) for code in codes]
            moved = [UsdGeom.PointBased(prims[0]).GetVelocitiesAttr().Get(code) for code in codes]
        if len(times) != last + 1 or abs(times[-1] - times[0] - last / rate) > 1e-6:
            raise ValueError(f"{form}: {len(times)} frames to {times[-1]} s of {last + 1} at {rate} a second")
        # Velocities are those of the frames before and after.
        for axis in range(3):
            wanted = (points[2][-1][axis] - points[0][-1][axis]) * rate / 2
            if abs(moved[1][-1][axis] - wanted) > 1e-3:
                raise ValueError(f"{form}: a velocity of {moved[1][-1][axis]} where points move at {wanted}")
        if math.dist(points[0][-1], points[2][-1]) < 1e-4:
            raise ValueError(f"{form}: the tip does not move")


def check_blender(cli, folder, project, name, expected, own, points, widest, blender):
    for form in BY_BLENDER:
        out = os.path.join(folder, f"{name}.out.{form.split('-')[0]}")
        run(cli, "export", project, "--format", form, "-o", out, "--output-unit", "m", "--force")
        objects = blender_objects(out, blender)
        hair = [one for one in objects if one["type"] == ("MESH" if form == "obj-lines" else "CURVES")]
        strands = sum(one.get("strands", 0) for one in hair)
        if form != "obj-lines" and strands != expected:
            raise ValueError(f"{form}: Blender has {strands} strands of {expected}")
        if sum(one["points"] for one in hair) != points:
            raise ValueError(f"{form}: Blender has {sum(one['points'] for one in hair)} points of {points}")
        if len(own) > 1 and len(hair) != len(own):
            raise ValueError(f"{form}: Blender has {len(hair)} objects of {len(own)} layers")
        # Blender numbers objects of one name: those of groups count, too.
        found = {legal(re.sub(r"\.\d{3}$", "", one["name"])) for one in hair}
        missing = [layer for layer, _ in own if len(own) > 1 and layer.isascii() and legal(layer) not in found]
        if missing:
            raise ValueError(f"{form}: Blender has no object named as {missing}: {sorted(found)}")
        largest = max(one["radius"][1] for one in hair) if form != "obj-lines" else 0
        if form != "obj-lines" and not math.isclose(largest, widest / 2, rel_tol=1e-3, abs_tol=1e-9):
            raise ValueError(f"{form}: Blender has radii of up to {largest} m; widths are up to {widest} m")


def check(cli, folder, name, all_blenders):
    path = os.path.join(folder, name)
    made, prims = shown(path)
    expected = strands_of(prims) + copied_strands(made)
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
    for form in ("abc", "abc-unreal", "obj-lines"):
        out = os.path.join(folder, f"{name}.{form}.{form.split('-')[0]}")
        run(cli, "export", project, "--format", form, "-o", out, "--force")
        if form == "abc":
            check_alembic(out, expected, own)
        elif form == "abc-unreal":
            for one in alembic_judge.curves_of(out):
                alembic_judge.check(one)
        again = out + ".hairloom"
        run(cli, "import", out, "-o", again, "--force")
        if len(own) > 1 and layers_of(cli, again) != own:
            raise ValueError(f"{form}: layers {own} came back as {layers_of(cli, again)}")
    for form in OTHERS:
        out = os.path.join(folder, f"{name}.{form}.{form.split('-')[0]}")
        report = run(cli, "export", project, "--format", form, "--points", "16", "-o", out, "--force")
        read = plain_readers.read_obj_c4d if form == "obj-c4d" else getattr(plain_readers, "read_" + form)
        found = read(out)
        if len(found) != expected or report["strands"] != expected or any(len(strand) != 16 for strand in found):
            raise ValueError(f"{form}: {len(found)} strands of {expected}")
    widest = max((max(UsdGeom.Curves(prim).GetWidthsAttr().Get() or [0]) for prim in written), default=0)
    for blender in all_blenders:
        check_blender(cli, folder, project, name, expected, own, imported["points"], widest, blender)
    if name.startswith("moving"):
        check_motion(cli, folder, project, name)
        check_shutter(cli, folder, project, name)
    return expected


def check_shutter(cli, folder, project, name):
    """Samples of a shutter stand at their times, with velocities of their own."""
    record = os.path.join(folder, name + ".frames")
    for form in ("abc", "usda", "usdc"):
        out = os.path.join(folder, f"{name}.shutter.{form}")
        report = run(cli, "export", project, "--format", form, "-o", out, "--record", record, "--frames", "3,5", "--start", "1001",
                     "--shutter", "-0.25:0.25", "--samples", "3", "--force")
        if report["frames"] != 3 or report["samples"] != 9:
            raise ValueError(f"{form}: {report['frames']} frames of {report['samples']} samples")
        wanted = [1001 + frame + exposure for frame in range(3) for exposure in (-0.25, 0, 0.25)]
        if form == "abc":
            one = alembic_judge.curves_of(out)[0]
            alembic_judge.check(one)
            numbers, points, moved = [time * 24 for time in one["times"]], one["frames"], one["velocities"]
        else:
            made, prims = shown(out)
            if (made.GetStartTimeCode(), made.GetEndTimeCode()) != (1001, 1003):
                raise ValueError(f"{form}: frames from {made.GetStartTimeCode()} to {made.GetEndTimeCode()}")
            curve = UsdGeom.Curves(prims[0])
            numbers = curve.GetPointsAttr().GetTimeSamples()
            points = [curve.GetPointsAttr().Get(code) for code in numbers]
            moved = [UsdGeom.PointBased(prims[0]).GetVelocitiesAttr().Get(code) for code in numbers]
        if len(numbers) != 9 or any(abs(a - b) > 1e-6 for a, b in zip(numbers, wanted)):
            raise ValueError(f"{form}: samples at {numbers}; expected {wanted}")
        for axis in range(3):
            speed = (points[5][-1][axis] - points[3][-1][axis]) * 48
            if abs(moved[4][-1][axis] - speed) > 1e-3 + 1e-3 * abs(speed):
                raise ValueError(f"{form}: a velocity of {moved[4][-1][axis]} where points move at {speed}")
        if math.dist(points[3][-1], points[5][-1]) < 1e-4:
            raise ValueError(f"{form}: the tip does not move while the shutter is open")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cli", required=True)
    parser.add_argument("--table", help="page whose table is written anew")
    parser.add_argument("-o", "--output", required=True)
    asked = parser.parse_args()
    os.makedirs(asked.output, exist_ok=True)
    found = blenders()
    judges = ", ".join(["usd-core", "the Alembic library"] + [f"Blender {version_of(one)}" for one in found])
    if not found:
        print("skipped: Blender's judgement, since its module bpy is not there for this Python")
    failed, lines = 0, []
    for make in STAGES:
        for ext in FORMATS:
            make(asked.output, ext)
            name = f"{make.__name__}.{ext}"
            try:
                strands = check(asked.cli, asked.output, name, found)
                if ext == FORMATS[-1]:
                    lines.append(f"| {make.__doc__.strip().rstrip('.')} | {strands} |" + " yes |" * 5)
                print(f"{name}: as {judges} have it")
            except (ValueError, KeyError) as problem:
                print(f"FAILED {name}: {problem}")
                failed += 1
    if asked.table and found and not failed:
        with open(asked.table, encoding="utf-8") as page:
            text = page.read()
        begin, end = text.index("| stage |"), text.index("<!-- end of the table of odd grooms -->")
        versions = ", ".join(version_of(one) for one in found)
        head = (f"| stage | strands | USD, by usd-core | Alembic, by its library | for Unreal, likewise | OBJ, `.hair`, TressFX, PLY, Cinema 4D, "
                f"by readers of their pages | USD, Alembic and OBJ in Blender {versions} |\n" + "|---" * 7 + "|\n")
        with open(asked.table, "w", encoding="utf-8") as page:
            page.write(text[:begin] + head + "\n".join(lines) + "\n" + text[end:])
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
