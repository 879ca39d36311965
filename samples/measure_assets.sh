#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# measure_assets.sh OUT [PAGE]: exports the sample hairstyles as runtime assets into OUT and prints their sizes and errors as a
# table, which replaces the one between the marks of PAGE (docs/formats/runtime.md) where that is named. Fails where follow
# hairs are more than 0.5 mm from those of rendered images and the exporter gives no reason.
set -euo pipefail

top=$(cd "$(dirname "$(readlink -f "$0")")/.." && pwd)
mkdir -p "${1:?a folder for the results}"
out=$(cd "$1" && pwd)
page=${2:+$(readlink -f "$2")}
export HAIRLOOM_CLI=${HAIRLOOM_CLI:-$top/build/release/bin/hairloom-cli}

# row NAME LABEL: of OUT/NAME.hairloom.
row() {
    "$HAIRLOOM_CLI" export "$out/$1.hairloom" --format runtime -o "$out/$1.hairrt" --force --json > "$out/$1.json"
    python3 - "$2" "$out/$1.json" <<'PY'
import json, sys
label, path = sys.argv[1:]
report = json.load(open(path))
hairs = {a["name"]: a["max_error"] for a in report["attributes"]}.get("follow hairs at rest")
said = [f["what"] for f in report["findings"] if f["where"] == "follow hairs" and f["severity"] == "info"]
count = said[0].split()[0] if said else "0"
points = report["points"] / report["strands"]
error = "–" if hairs is None else f"{hairs * 1e3:.2f} mm"
print(f"| {label} | {report['strands']:,} × {points:g} | {int(count):,} | {report['bytes']:,} | "
      f"{report['bytes'] / report['strands']:.0f} | {report['max_error_mm']:.3f} mm | {error} |")
if hairs is not None and hairs > 5e-4 and not any(f["severity"] == "warning" and f["where"] == "follow hairs"
                                                  for f in report["findings"]):
    sys.exit(f"{label}: follow hairs are {hairs * 1e3:.2f} mm off, and nothing says why")
PY
}

cd "$top"
table=$out/table.md
{
    echo '| hairstyle | strands × points | follow hairs | bytes | bytes a strand | point error | hair error |'
    echo '|---|---|---|---|---|---|---|'
} > "$table"
for style in short shoulder long bob afro braid; do
    samples/make_hairstyle.sh --project-only --spheres-only "$style" "$out" > "$out/$style.txt"
    row "$style" "sample $style" >> "$table"
done
# Few guides with many hairs each, as games have them.
"$HAIRLOOM_CLI" create --mesh samples/bust/bust.glb --scalp material:scalp --count 300 --placement dart --length 0.5 \
    --points 24 --seed 1 -o "$out/few.hairloom" --force > /dev/null
sed 's/"settings": {"count": 3000,/"settings": {"count": 300,/' samples/hairstyles/long.json > "$out/few.json.script"
"$HAIRLOOM_CLI" groom "$out/few.hairloom" --script "$out/few.json.script" -o "$out/few.hairloom" --force > /dev/null
"$HAIRLOOM_CLI" set "$out/few.hairloom" interpolation.followPerGuide=100 -o "$out/few.hairloom" --force > /dev/null
row few "long sample's script on 300 guides" >> "$table"
cat "$table"
[ -z "$page" ] || samples/put_table.sh "$table" "$page"
