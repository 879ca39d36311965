# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves of an Alembic file as the Alembic library itself has them (its Python module alembic3d)."""
import math

import alembic3d

Abc, AbcGeom = alembic3d.Abc, alembic3d.AbcGeom


def properties_of(compound):
    """Name, scope and values of each property; a name that appears twice is an error."""
    found = {}
    if not compound.valid():
        return found
    for i in range(compound.getNumProperties()):
        header = compound.getPropertyHeader(i)
        name = header.getName()
        if name in found:
            raise ValueError(f"{name} appears twice")
        if header.isArray():
            values = list(Abc.IArrayProperty(compound, name).getValue())
        elif header.isScalar():
            values = [Abc.IScalarProperty(compound, name).getValue()]
        else:
            continue
        found[name] = (header.getMetaData().get("geoScope"), values)
    return found


def curves_of(path):
    """A dictionary for each object of curves: path, counts, points and velocities by time, widths, properties, and the
    name that the object says its group has."""
    found = []

    def visit(node):
        header = node.getHeader()
        if AbcGeom.ICurves.matches(header):
            schema = AbcGeom.ICurves(node.getParent(), header.getName()).getSchema()
            sampling = schema.getTimeSampling()
            value = schema.getValue()
            frames, velocities, times = [], [], []
            for i in range(schema.getNumSamples()):
                times.append(sampling.getSampleTime(i))
                # By time: this module takes a whole number for seconds, too (findings/alembic-sample-index.sh).
                sample = schema.getValue(Abc.ISampleSelector(times[-1]))
                frames.append([(p[0], p[1], p[2]) for p in sample.getPositions()])
                moved = sample.getVelocities()
                velocities.append([(v[0], v[1], v[2]) for v in moved] if moved else [])
            user = properties_of(schema.getUserProperties())
            widths = schema.getWidthsParam()
            found.append({
                "path": header.getFullName(), "counts": list(value.getCurvesNumVertices()), "frames": frames,
                "velocities": velocities, "times": times,
                "widths": list(widths.getExpandedValue().getVals()) if widths.valid() else [],
                "properties": properties_of(schema.getArbGeomParams()),
                "group": user.get("groom_group_name", (None, [None]))[1][0]})
        for child in node.children:
            visit(child)

    visit(Abc.IArchive(path).getTop())
    return found


def check(curves):
    """What any reader relies on: counts that add up, and a value for each strand or point."""
    points = len(curves["frames"][0])
    if sum(curves["counts"]) != points:
        raise ValueError(f"{curves['path']}: {sum(curves['counts'])} points in counts, {points} points")
    for frame, moved in zip(curves["frames"], curves["velocities"]):
        if len(frame) != points or len(moved) not in (0, points):
            raise ValueError(f"{curves['path']}: a frame of {len(frame)} points and {len(moved)} velocities")
        if not all(math.isfinite(c) for p in frame + moved for c in p):
            raise ValueError(f"{curves['path']}: a point is not finite")
    if len(curves["widths"]) != points:
        raise ValueError(f"{curves['path']}: {len(curves['widths'])} widths for {points} points")
    sizes = {"vtx": points, "uni": len(curves["counts"]), "con": 1}
    for name, (scope, values) in curves["properties"].items():
        # Whole vectors of three stand as numbers.
        if scope in sizes and len(values) not in (sizes[scope], 3 * sizes[scope]):
            raise ValueError(f"{name} of {curves['path']}: {len(values)} values, {scope}")
