#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# measure_contact.sh OUT [PAGE [STYLE...]]: fits the skin collider to the sample hairstyles and moves them in wind of 3 m/s for a
# second, each by a clip, a nod and a spin, with two follow hairs per guide. Prints how deep drawn hair comes into the mesh as a table, which replaces the one
# between the marks of PAGE (docs/contact.md) where that is named.
set -euo pipefail

top=$(cd "$(dirname "$(readlink -f "$0")")/.." && pwd)
mkdir -p "${1:?a folder for the results}"
out=$(cd "$1" && pwd)
page=${2:+$(readlink -f "$2")}
shift $(($# < 2 ? $# : 2))
styles=("$@")
[ ${#styles[@]} -gt 0 ] || styles=(short shoulder long bob afro braid)
export HAIRLOOM_CLI=${HAIRLOOM_CLI:-$top/build/release/bin/hairloom-cli}

cd "$top"
for style in "${styles[@]}"; do
    [ -f "$out/$style.hairloom" ] || samples/make_hairstyle.sh --project-only "$style" "$out" > "$out/$style.txt"
    "$HAIRLOOM_CLI" set "$out/$style.hairloom" interpolation.followPerGuide=2 -o "$out/$style-few.hairloom" --force > /dev/null
    "$HAIRLOOM_CLI" colliders "$out/$style-few.hairloom" --fit field -o "$out/$style-skin.hairloom" --force --json \
        > "$out/$style-fit.json" 2> "$out/$style-fit.txt"
    for motion in clip:nod_and_turn nod spin; do
        "$HAIRLOOM_CLI" simulate "$out/$style-skin.hairloom" --frames 60 --fps 60 --wind 3,0,0 --motion "$motion" --json \
            > "$out/$style-${motion#clip:}.json"
    done
done
table=$out/table.md
python3 - "$out" "${styles[@]}" > "$table" <<'PY'
import json, sys
out, *styles = sys.argv[1:]
print("| sample | clip | nod | spin | authored | worst gap | kB |\n|---|---|---|---|---|---|---|")
for style in styles:
    reports = [json.load(open(f"{out}/{style}-{motion}.json")) for motion in ("nod_and_turn", "nod", "spin")]
    cells = [f"{r['max_mesh_penetration_mm']:.1f} ({r['max_guide_penetration_mm']:.1f})" for r in reports]
    fit = json.load(open(f"{out}/{style}-fit.json"))
    print(f"| {style} | {' | '.join(cells)} | {reports[0]['authored_depth_mm']:.1f} | {fit['worst_gap_mm']:.1f} | "
          f"{fit['bytes'] / 1000:.0f} |")
PY
cat "$table"
[ -z "$page" ] || samples/put_table.sh "$table" "$page"
