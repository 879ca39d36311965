#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: findings/usd-property-twice.sh
# USD's text reader (usd-core 26.11) does not always refuse a prim that states a property twice. Of two statements of one type the
# second counts, without a word. With another type the whole layer does not open. A metadatum of a property is gathered from both
# statements. So a writer that names a primvar twice passes every test that its own data happens to have one type in, and loses
# values in silence.
# Opens three layers of one prim and prints what is there. Fails if any answer is another one.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q usd-core==26.11
cat > twice.py <<'CODE'
import sys
from pxr import Tf, Usd

HEAD = '#usda 1.0\ndef BasisCurves "hair"\n{\n'


def look(title, body, expected):
    open("twice.usda", "w").write(HEAD + body + "}\n")
    try:
        stage = Usd.Stage.Open("twice.usda")
        prim = stage.GetPrimAtPath("/hair")
        attribute = prim.GetAttribute("primvars:age")
        found = (list(attribute.Get()), attribute.GetMetadata("interpolation"), len(prim.GetAuthoredPropertyNames()))
    except Tf.ErrorException:
        found = "does not open"
    print(f"{title}: {found}")
    return found == expected


good = look("one type, twice", '    float[] primvars:age = [1, 2] (interpolation = "uniform")\n    float[] primvars:age = [3]\n',
            ([3.0], "uniform", 1))
good &= look("two types", "    float[] primvars:age = [1, 2]\n    int[] primvars:age = [3]\n", "does not open")
good &= look("once", '    float[] primvars:age = [1, 2] (interpolation = "uniform")\n', ([1.0, 2.0], "uniform", 1))
print(Usd.GetVersion())
sys.exit(0 if good else 1)
CODE
venv/bin/python twice.py 2>/dev/null
