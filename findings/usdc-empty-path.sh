#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: findings/usdc-empty-path.sh
# The PATHS section of a binary USD layer (usd-core 26.11, file version 0.8) begins with two counts: how many paths the layer has, and
# how many its compressed lists spell out. They look like the same number twice, since they are equal in nearly every file. They
# differ by one where a reference or a payload names no prim: its empty path has a place in the table, and no entry in the lists. So a
# reader that takes either count for the other refuses such a file, or reads the lists a place too far, and both kinds of layer
# hold the same specs. Layers that refer to another file's default prim are what most pipelines write.
# Writes five layers and prints both counts of each. Fails if any is another one.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q usd-core==26.11
cat > counts.py <<'CODE'
import struct
import sys
from pxr import Sdf, Usd


def counts(file):
    """What the PATHS section begins with."""
    data = open(file, "rb").read()
    (contents,) = struct.unpack_from("<q", data, 16)
    (sections,) = struct.unpack_from("<Q", data, contents)
    for i in range(sections):
        name, start, _ = struct.unpack_from("<16sqq", data, contents + 8 + 32 * i)
        if name.rstrip(b"\0") == b"PATHS":
            return tuple(data[8:11]), struct.unpack_from("<QQ", data, start)


def look(title, expected, references=(), payloads=()):
    file = title.replace(" ", "-") + ".usdc"
    layer = Sdf.Layer.CreateNew(file)
    prim = Sdf.CreatePrimInLayer(layer, "/hair")
    prim.specifier = Sdf.SpecifierDef
    prim.referenceList.prependedItems = list(references)
    prim.payloadList.prependedItems = list(payloads)
    layer.Save()
    specs = []
    layer.Traverse("/", lambda path: specs.append(str(path)))
    version, found = counts(file)
    print(f"{title}: {found[0]} paths, {found[1]} in lists, specs {sorted(specs)}, version {version}")
    return found == expected and sorted(specs) == ["/", "/hair"]


good = look("no arc", (2, 2))
good &= look("reference to a prim", (3, 3), [Sdf.Reference("groom.usdc", "/groom")])
good &= look("reference to the default prim", (3, 2), [Sdf.Reference("groom.usdc")])
good &= look("payload of a prim", (3, 3), [], [Sdf.Payload("groom.usdc", "/groom")])
good &= look("payload of the default prim", (3, 2), [], [Sdf.Payload("groom.usdc")])
print(Usd.GetVersion())
sys.exit(0 if good else 1)
CODE
venv/bin/python counts.py
