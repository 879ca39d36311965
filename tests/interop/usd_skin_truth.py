# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes skinned stages with Pixar's usd-core, and the points that UsdSkel computes of them, for
tests/importers/usd_skin_test.cpp: `python3 usd_skin_truth.py FOLDER`."""

import json
import math
import pathlib
import random
import sys

from pxr import Gf, Sdf, Usd, UsdGeom, UsdSkel, Vt

TIMES = [1, 2.5, 13, 22]  # of samples, and parts of the way between them that halves hold exactly
JOINTS = ["hips", "hips/spine", "hips/spine/neck", "hips/spine/neck/head", "hips/spine/neck/head/jaw"]
chance = random.Random(3)


def turned(axis, degrees):
    return Gf.Matrix4d(Gf.Rotation(Gf.Vec3d(*axis), degrees), Gf.Vec3d(0))


def moved(x, y, z):
    return Gf.Matrix4d(1).SetTranslate(Gf.Vec3d(x, y, z))


def ball(size, aside):
    """A sphere without poles: 4 rings of 3 points."""
    n = 3
    points, counts, indices, uvs = [], [], [], []
    for i in range(n + 1):
        for j in range(n):
            down, around = math.pi * (0.05 + 0.9 * i / n), 2 * math.pi * j / n
            points.append((size * (0.1 * math.sin(down) * math.cos(around) + 0.3 * aside),
                           size * (1.6 + 0.12 * math.cos(down)),
                           size * 0.1 * math.sin(down) * math.sin(around)))
    for i in range(n):
        for j in range(n):
            corners = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)]
            indices += [k * n + m % n for k, m in corners]
            uvs += [Gf.Vec2f(m / n, 1 - k / n) for k, m in corners]
            counts.append(4)
    return points, counts, indices, uvs


def add_mesh(stage, path, aside, size, up, joints, remapped, rigid, transform, bound_in, of_point=3):
    mesh = UsdGeom.Mesh.Define(stage, path)
    points, counts, indices, uvs = ball(size, aside)
    if up == "Z":
        points = [(x, -z, y) for x, y, z in points]
    if transform is not None:  # which a skin replaces
        UsdGeom.Xformable(mesh).AddTransformOp().Set(transform)
    bind = turned((0, 1, 0), 30) * moved(0.01 * size, 0.02 * size, 0)
    points = [Gf.Vec3f(bind.GetInverse().Transform(Gf.Vec3d(*p))) for p in points]
    mesh.CreatePointsAttr(points)
    mesh.CreateFaceVertexCountsAttr(counts)
    mesh.CreateFaceVertexIndicesAttr(indices)
    mesh.CreateSubdivisionSchemeAttr("none")
    UsdGeom.PrimvarsAPI(mesh).CreatePrimvar(
        "st", Sdf.ValueTypeNames.TexCoord2fArray, "faceVarying").Set(Vt.Vec2fArray(uvs))
    binding = UsdSkel.BindingAPI.Apply(mesh.GetPrim())
    binding.CreateSkeletonRel().SetTargets(["/Char/Skel"])
    binding.CreateGeomBindTransformAttr(bind * bound_in)
    own = joints
    if remapped:
        own = [joints[i] for i in (3, 2, 4, 1)]
        binding.CreateJointsAttr(own)
    if rigid:
        binding.CreateJointIndicesPrimvar(True, 2).Set(Vt.IntArray([0, 1]))
        binding.CreateJointWeightsPrimvar(True, 2).Set(Vt.FloatArray([0.75, 0.25]))
        return
    numbers, weights = [], []
    for _ in points:
        some = chance.sample(range(len(own)), of_point)
        shares = [chance.random() for _ in some]
        numbers += some + [0]
        weights += [share / sum(shares) for share in shares] + [0]
    binding.CreateJointIndicesPrimvar(False, of_point + 1).Set(Vt.IntArray(numbers))
    binding.CreateJointWeightsPrimvar(False, of_point + 1).Set(Vt.FloatArray(weights))


def add_animation(stage, skeleton, joints, local, size):
    animation = UsdSkel.Animation.Define(stage, "/Char/walk")
    moving = [joint for joint in joints if joint != "hips/spine"][::-1]
    animation.CreateJointsAttr(moving)
    places = animation.CreateTranslationsAttr()
    rotations = animation.CreateRotationsAttr()
    factors = animation.CreateScalesAttr()
    for time in (1, 7, 13, 25):
        poses = []
        for joint in moving:
            axis = [chance.random() for _ in range(3)]
            poses.append(turned(axis, 40 * chance.random()) * local[joints.index(joint)] *
                         moved(0.02 * size * chance.random(), 0, 0.01 * size * chance.random()))
        places.Set(Vt.Vec3fArray([Gf.Vec3f(p.ExtractTranslation()) for p in poses]), time)
        rotations.Set(Vt.QuatfArray([Gf.Quatf(p.ExtractRotationQuat()) for p in poses]), time)
        factors.Set(Vt.Vec3hArray([Gf.Vec3h(1, 1 + 0.25 * chance.randint(0, 1), 1) for _ in poses]), time)
    skeleton.CreateAnimationSourceRel().SetTargets(["/Char/walk"])


def add_shapes(stage, path, names, size, count):
    """Two shapes, the second of some points alone."""
    binding = UsdSkel.BindingAPI(stage.GetPrimAtPath(path))
    for name, points in zip(names, (range(count), (1, 4, 7))):
        shape = UsdSkel.BlendShape.Define(stage, f"{path}/{name}")
        shape.CreateOffsetsAttr(Vt.Vec3fArray([Gf.Vec3f(*(0.03 * size * chance.uniform(-1, 1) for _ in range(3)))
                                               for _ in points]))
        if len(points) < count:
            shape.CreatePointIndicesAttr(Vt.IntArray(list(points)))
    binding.CreateBlendShapesAttr(names)
    binding.CreateBlendShapeTargetsRel().SetTargets([f"{path}/{name}" for name in names])
    animation = UsdSkel.Animation(stage.GetPrimAtPath("/Char/walk"))
    animation.CreateBlendShapesAttr(["nobody", *names[::-1]])
    for time in (1, 13, 25):
        animation.CreateBlendShapeWeightsAttr().Set(
            Vt.FloatArray([1, *(chance.uniform(0, 1.2) for _ in names)]), time)


def add_points_stage(folder, name, up="Y", unit=0.01, moves=False, start=1, suffix="usda"):
    """A cache of points as of any rig: a ball that turns and goes, and whose last row goes elsewhere."""
    stage = Usd.Stage.CreateNew(str(folder / f"{name}.{suffix}"))
    UsdGeom.SetStageUpAxis(stage, up)
    UsdGeom.SetStageMetersPerUnit(stage, unit)
    stage.SetTimeCodesPerSecond(24)
    stage.SetStartTimeCode(start)
    stage.SetEndTimeCode(25)
    size = 1 / unit
    root = UsdGeom.Xform.Define(stage, "/Char")
    stage.SetDefaultPrim(root.GetPrim())
    if moves:
        place = UsdGeom.Xformable(root).AddTranslateOp()
        for time in (1, 25):
            place.Set(Gf.Vec3d(0.2 * size * (time - 1) / 24, 0, 0), time)
    mesh = UsdGeom.Mesh.Define(stage, "/Char/Head")
    points, counts, indices, _ = ball(size, 0)
    if up == "Z":
        points = [(x, -z, y) for x, y, z in points]
    mesh.CreateFaceVertexCountsAttr(counts)
    mesh.CreateFaceVertexIndicesAttr(indices)
    mesh.CreateSubdivisionSchemeAttr("none")
    for time in range(1, 26):
        motion = turned((0.2, 1, 0.3), 4.0 * time) * moved(0.01 * size * time, 0, 0.002 * size * time)
        jaw = Gf.Vec3d(0, 0.03 * size * math.sin(time), 0)
        mesh.CreatePointsAttr().Set([Gf.Vec3f(motion.Transform(Gf.Vec3d(*p) + (jaw if i >= 9 else Gf.Vec3d(0))))
                                     for i, p in enumerate(points)], time)
    stage.Save()
    frames = []
    for time in (start, 7, 13, 22):  # of samples
        world = UsdGeom.Xformable(mesh).ComputeLocalToWorldTransform(time)
        frames.append({"t": (time - start) / 24,
                       "p": in_metres([world.Transform(Gf.Vec3d(p)) for p in mesh.GetPointsAttr().Get(time)], unit, up)})
    (folder / f"{name}.json").write_text(json.dumps({"file": f"{name}.{suffix}", "skins": False, "frames": frames}))


def add_stage(folder, name, suffix="usda", up="Y", unit=0.01, above=None, bound_above=True, mesh_transform=None,
              is_animated=True, rests_elsewhere=False, moves=False, rate=24, remapped=False, rigid=False, shapes=(), of_point=3):
    stage = Usd.Stage.CreateNew(str(folder / f"{name}.{suffix}"))
    UsdGeom.SetStageUpAxis(stage, up)
    UsdGeom.SetStageMetersPerUnit(stage, unit)
    stage.SetTimeCodesPerSecond(rate)
    stage.SetStartTimeCode(1)
    stage.SetEndTimeCode(25)
    size = 1 / unit
    root = UsdSkel.Root.Define(stage, "/Char")
    stage.SetDefaultPrim(root.GetPrim())
    if above is not None:
        UsdGeom.Xformable(root).AddTransformOp().Set(above)
    if moves:
        turn = UsdGeom.Xformable(root).AddRotateYOp()
        for time in (1, 13, 25):
            turn.Set(15.0 * (time - 1), time)
        place = UsdGeom.Xformable(root).AddTranslateOp()
        for time in (1, 25):
            place.Set(Gf.Vec3d(0.1 * size * (time - 1) / 24, 0, 0), time)
    local = [moved(0, size, 0), moved(0, 0.3 * size, 0), turned((1, 0, 0), 10) * moved(0, 0.2 * size, 0),
             turned((1, 0, 0), -10) * moved(0, 0.08 * size, 0), moved(0, 0, 0.05 * size)]
    if up == "Z":
        local[0] = local[0] * turned((1, 0, 0), 90)
    skeleton = UsdSkel.Skeleton.Define(stage, "/Char/Skel")
    skeleton.CreateJointsAttr(JOINTS)
    rest = list(local)
    if rests_elsewhere:
        rest[0] = local[0] * moved(0.02 * size, 0.01 * size, 0)
        rest[2] = turned((0, 0, 1), 20) * local[2]
    skeleton.CreateRestTransformsAttr(rest)
    bound_in = root.ComputeLocalToWorldTransform(1.0) if bound_above else Gf.Matrix4d(1)
    bind = []
    for transform in local:  # a chain
        bind.append(transform * (bind[-1] if bind else Gf.Matrix4d(1)))
    skeleton.CreateBindTransformsAttr([transform * bound_in for transform in bind])
    for path, aside, is_rigid in (("/Char/Head", 0, rigid), ("/Char/Body", 1, False)):
        add_mesh(stage, path, aside, size, up, JOINTS, remapped, is_rigid, mesh_transform, bound_in, of_point)
    binding = UsdSkel.BindingAPI.Apply(skeleton.GetPrim())
    if is_animated:
        add_animation(stage, binding, JOINTS, local, size)
    for path in ("/Char/Head", "/Char/Body") if shapes else ():
        add_shapes(stage, path, list(shapes), size, 12)
    stage.Save()
    frames = [{"t": (time - 1) / rate, "p": posed(stage, root, time, unit, up)} for time in TIMES]
    (folder / f"{name}.json").write_text(json.dumps({"file": f"{name}.{suffix}", "frames": frames}))


def posed(stage, root, time, unit, up):
    """All points of all meshes, in metres, Y up."""
    cache = UsdSkel.Cache()
    cache.Populate(root, Usd.TraverseInstanceProxies())
    points = []
    for binding in cache.ComputeSkelBindings(root, Usd.TraverseInstanceProxies()):
        transforms = cache.GetSkelQuery(binding.GetSkeleton()).ComputeSkinningTransforms(time)
        world = UsdGeom.Xformable(binding.GetSkeleton()).ComputeLocalToWorldTransform(time)
        for query in binding.GetSkinningTargets():
            rest = Vt.Vec3fArray(UsdGeom.Mesh(query.GetPrim()).GetPointsAttr().Get(time))
            if query.HasBlendShapes():
                rest = morphed(query, cache.GetSkelQuery(binding.GetSkeleton()).GetAnimQuery(), rest, time)
            if query.IsRigidlyDeformed():
                carried = query.ComputeSkinnedTransform(transforms, time)
                skinned = [carried.Transform(Gf.Vec3d(point)) for point in rest]
            else:
                assert query.ComputeSkinnedPoints(transforms, rest, time)
                skinned = [Gf.Vec3d(point) for point in rest]
            points += in_metres([world.Transform(point) for point in skinned], unit, up)
    return points


def in_metres(points, unit, up):
    """Y up."""
    return [[round(unit * c, 6) for c in ((x, z, -y) if up == "Z" else (x, y, z))] for x, y, z in points]


def morphed(query, animation, rest, time):
    shapes = UsdSkel.BlendShapeQuery(UsdSkel.BindingAPI(query.GetPrim()))
    weights = query.GetBlendShapeMapper().Remap(animation.ComputeBlendShapeWeights(time))
    some, of_shapes, parts = shapes.ComputeSubShapeWeights(weights)
    assert shapes.ComputeDeformedPoints(some, of_shapes, parts, shapes.ComputeBlendShapePointIndices(),
                                        shapes.ComputeSubShapePointOffsets(), rest)
    return rest


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    aside = turned((0, 1, 0), 40) * moved(30, 5, 2)
    add_stage(folder, "plain")
    add_stage(folder, "metres", suffix="usdc", unit=1.0)
    add_stage(folder, "z_up", up="Z", unit=1.0)
    add_stage(folder, "root_turned", above=aside)
    add_stage(folder, "root_scaled", above=Gf.Matrix4d().SetScale(0.5) * moved(3, 5, 2))
    add_stage(folder, "root_sheared", above=Gf.Matrix4d(1, 0.3, 0, 0, 0, 1, 0, 0, 0, 0, 2, 0, 1, 2, 3, 1))
    add_stage(folder, "root_moving", moves=True, rate=30)
    add_stage(folder, "bound_in_skeleton", above=aside, bound_above=False)
    add_stage(folder, "rests_elsewhere", rests_elsewhere=True)
    add_stage(folder, "no_animation", is_animated=False, rests_elsewhere=True)
    add_stage(folder, "mesh_transform", mesh_transform=moved(500, 0, 0))
    add_stage(folder, "own_joints", remapped=True)
    add_stage(folder, "rigid", suffix="usdc", rigid=True)
    add_stage(folder, "blend_shapes", shapes=("smile", "blink"))
    add_stage(folder, "blend_shapes_z_up", suffix="usdc", up="Z", unit=1.0, shapes=("brow",), moves=True)
    add_stage(folder, "five_joints", of_point=5)
    add_points_stage(folder, "points")
    add_points_stage(folder, "points_z_up", up="Z", unit=1.0, moves=True, suffix="usdc")
    add_points_stage(folder, "points_later", start=7)


if __name__ == "__main__":
    main()
