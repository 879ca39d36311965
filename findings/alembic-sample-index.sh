#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: findings/alembic-sample-index.sh
# In the Python module alembic3d 1.8.12.1 (the bindings of the Alembic library 1.8.12), ISampleSelector(3) asks for the time of 3 seconds
# and not for sample 3, although its first signature takes a whole number for an index: Boost.Python tries the signature that was
# registered last, and turns the int into a float. Frames are a fraction of a second, so that every index but 0 gives the last
# sample, without a word. A check that holds neighbouring samples against each other compares the last one with itself then, and passes
# whatever the file has. getSampleTime() of the sampling gives the time to ask for.
# Writes ten frames at 24 a second and reads them by index and by time. Fails if any answer is another one.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q alembic3d==1.8.12.1
cat > samples.py <<'CODE'
import sys

import alembic3d
import imath

Abc, AbcGeom = alembic3d.Abc, alembic3d.AbcGeom


def write(file):
    archive = Abc.OArchive(file)
    sampling = alembic3d.AbcCoreAbstract.TimeSampling(1 / 24, 0.0)
    transform = AbcGeom.OXform(archive.getTop(), "moves").getSchema()
    transform.setTimeSampling(archive.addTimeSampling(sampling))
    for frame in range(10):
        sample = AbcGeom.XformSample()
        sample.setTranslation(imath.V3d(frame, 0, 0))
        transform.set(sample)


def places(schema, selectors):
    return [round(schema.getValue(one).getMatrix()[3][0], 6) for one in selectors]


write("moves.abc")
schema = AbcGeom.IXform(Abc.IArchive("moves.abc").getTop(), "moves").getSchema()
sampling = schema.getTimeSampling()
by_index = [Abc.ISampleSelector(i) for i in range(10)]
by_time = [Abc.ISampleSelector(sampling.getSampleTime(i)) for i in range(10)]
print("requested index and time of ISampleSelector(3):", by_index[3].getRequestedIndex(), by_index[3].getRequestedTime())
print("by index:", places(schema, by_index))
print("by time: ", places(schema, by_time))
good = (by_index[3].getRequestedIndex(), by_index[3].getRequestedTime()) == (-1, 3.0)
good &= places(schema, by_index) == [0.0] + [9.0] * 9
good &= places(schema, by_time) == [float(i) for i in range(10)]
sys.exit(0 if good else 1)
CODE
venv/bin/python samples.py
