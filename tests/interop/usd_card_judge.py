# SPDX-License-Identifier: GPL-3.0-or-later
"""usd_card_judge.py FILE.usda…: has Pixar's usd-core judge cards and strands, each variant of them, and its UsdLod choose
levels by distance; fails on any error."""

import sys

from pxr import Gf, Usd, UsdGeom, UsdLod, UsdShade, UsdValidation


def strands_of(curves):
    """Of curves that are sound, in a material: a number of points and a width for each, an extent that holds them."""
    counts, points, widths = (a.Get() for a in (curves.GetCurveVertexCountsAttr(), curves.GetPointsAttr(), curves.GetWidthsAttr()))
    colours = UsdGeom.PrimvarsAPI(curves).GetPrimvar("displayColor")
    material, _ = UsdShade.MaterialBindingAPI(curves.GetPrim()).ComputeBoundMaterial()
    if sum(counts) != len(points) or len(widths) != len(points) or len(colours.Get()) != len(points) or min(counts) < 2:
        raise SystemExit(f"{curves.GetPath()}: arrays of other lengths than the points")
    if not material or curves.GetWidthsInterpolation() != "vertex" or min(widths) < 0 or max(widths) > 0.01:
        raise SystemExit(f"{curves.GetPath()}: no material, or widths of {min(widths)} to {max(widths)} m")
    own, shown = curves.GetExtentAttr().Get(), UsdGeom.Boundable.ComputeExtentFromPlugins(curves, Usd.TimeCode.Default())
    if any(abs(a - b) > 1e-5 for low, high in zip(own, shown) for a, b in zip(low, high)):
        raise SystemExit(f"{curves.GetPath()}: an extent of {own}; expected {shown}")
    return len(counts)


def triangles_of(mesh):
    """Of a mesh that is sound, in a material, or strands of curves; says what is wrong with others."""
    if isinstance(mesh, UsdGeom.BasisCurves):
        return strands_of(mesh)
    counts = mesh.GetFaceVertexCountsAttr().Get()
    points = mesh.GetPointsAttr().Get()
    sound, why = UsdGeom.Mesh.ValidateTopology(mesh.GetFaceVertexIndicesAttr().Get(), counts, len(points))
    material, _ = UsdShade.MaterialBindingAPI(mesh.GetPrim()).ComputeBoundMaterial()
    if not sound or not material:
        raise SystemExit(f"{mesh.GetPath()}: {why or 'no material'}")
    return len(counts)


def meshes_of(stage):
    shapes = [prim for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh) or prim.IsA(UsdGeom.BasisCurves)]
    return [UsdGeom.Mesh(prim) if prim.IsA(UsdGeom.Mesh) else UsdGeom.BasisCurves(prim) for prim in shapes]


def check_levels(file, stage, count):
    """In the variant of all levels, UsdLod takes the one that belongs to a distance."""
    roots = [prim for prim in stage.Traverse() if prim.HasAPI(UsdLod.RootAPI)]
    if len(roots) != 1 or len(roots[0].GetChildren()) != count:
        raise SystemExit(f"{file}: {len(roots)} roots of UsdLod; expected one of {count} levels")
    (path,) = UsdLod.RootAPI(roots[0]).GetLodHeuristicsRel().GetTargets()
    heuristic = UsdLod.DistanceHeuristic.Get(stage, path)
    thresholds = list(heuristic.GetThresholdsAttr().Get())
    if len(thresholds) != count - 1 or thresholds != sorted(set(thresholds)):
        raise SystemExit(f"{file}: thresholds {thresholds} of {count} levels")
    centre = heuristic.GetCenterAttr().Get()
    for level in range(count):
        before = thresholds[level - 1] if level else 0
        after = thresholds[level] if level < len(thresholds) else before + 2
        eye = Gf.Vec3d(centre) + Gf.Vec3d(0, 0, (before + after) / 2)
        chosen = heuristic.ComputeLOD(eye, Gf.Matrix4d(1))
        if chosen != level:
            raise SystemExit(f"{file}: {(before + after) / 2} m away UsdLod takes level {chosen}, not {level}")


def main():
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    failed = False
    for file in sys.argv[1:]:
        stage = Usd.Stage.Open(file)
        variants = stage.GetDefaultPrim().GetVariantSets().GetVariantSet("lod")
        levels = [name for name in variants.GetVariantNames() if name != "UsdLod"]
        triangles = []
        for name in levels:
            variants.SetVariantSelection(name)
            (mesh,) = meshes_of(stage)
            triangles.append(triangles_of(mesh))
            override = UsdLod.OverrideAPI(stage.GetDefaultPrim())
            if override.GetLodOverrideModeAttr().Get() != "indexedLOD" or override.GetLodOverrideIndexAttr().Get() != 0:
                raise SystemExit(f"{file}: UsdLod may take another level in variant {name}")
        variants.SetVariantSelection("UsdLod")
        if [triangles_of(mesh) for mesh in meshes_of(stage)] != triangles:
            raise SystemExit(f"{file}: the levels of UsdLod are not those of the variants")
        check_levels(file, stage, len(levels))
        errors = UsdValidation.ValidationContext(validators).Validate(stage)
        print(f"{file}: {len(errors)} errors, triangles or strands of its levels {triangles}")
        for error in errors:
            print(f"  {error.GetName()}: {error.GetMessage()}")
        failed = failed or bool(errors) or not triangles
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
