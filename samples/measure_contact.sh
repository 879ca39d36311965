#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# measure_contact.sh OUT [PAGE [NAME...]]: makes both tables of docs/contact.md. Fits the skin collider to the sample hairstyles, and to bare
# hair on the heads and characters of ../shared/data where that is. Moves them for a second: in wind of 3 m/s by a clip, a nod and a spin, and
# at 5 m/s to a dead stop. Prints how deep drawn hair comes into the mesh as a table. Without NAMEs it runs `bench contact`, too, for what else
# is measured where hair touches. Both replace those between the marks of PAGE (docs/contact.md) where that is named.
set -euo pipefail

top=$(cd "$(dirname "$(readlink -f "$0")")/.." && pwd)
mkdir -p "${1:?a folder for the results}"
out=$(cd "$1" && pwd)
page=${2:+$(readlink -f "$2")}
shift $(($# < 2 ? $# : 2))
names=("$@")
export HAIRLOOM_CLI=${HAIRLOOM_CLI:-$top/build/release/bin/hairloom-cli}

cd "$top"
data=../shared/data
# bare NAME: hair on a head or a character, which nobody groomed.
bare() {
    case $1 in
        sintel) set -- "$1" heads/sintel.obj --scalp above:0.85 ;;
        makehuman) set -- "$1" heads/makehuman_base.obj --unit dm --scalp group:body,above:0.94,cap:90 --leave-out 'helper*,joint*' ;;
        cesium-man) set -- "$1" animated/CesiumMan.glb --scalp above:0.9 ;;
        green-man) set -- "$1" animated/raylib_greenman.glb --scalp above:0.9 ;;
        *) echo "error: no sample, head or character '$1'" >&2; exit 2 ;;
    esac
    "$HAIRLOOM_CLI" create --mesh "$data/$2" "${@:3}" --count 1000 --length 0.2 -o "$out/$1-few.hairloom" --force > "$out/$1.txt" 2>&1
}
all=
if [ ${#names[@]} -eq 0 ]; then
    all=1
    names=(short shoulder long bob afro braid)
    [ ! -d "$data/animated" ] || names+=(sintel makehuman cesium-man green-man cesium-man+spheres green-man+spheres)
fi
echo '{"keys": [{"t": 0, "translate": [0, 0, 0]}, {"t": 0.3, "translate": [1.5, 0, 0]}]}' > "$out/stop.json"
for name in "${names[@]}"; do
    # NAME+spheres: with 12 fitted spheres in place of the skin.
    base=${name%+*} fit=field
    [ "$base" = "$name" ] || fit=${name#*+}
    motions=(nod spin "$out/stop.json")
    if [ -f "samples/hairstyles/$base.conf" ]; then
        [ -f "$out/$base.hairloom" ] || samples/make_hairstyle.sh --project-only "$base" "$out" > "$out/$base.txt"
        "$HAIRLOOM_CLI" set "$out/$base.hairloom" interpolation.followPerGuide=2 -o "$out/$base-few.hairloom" --force > /dev/null
        motions+=(clip:nod_and_turn)
    else
        bare "$base"
        case $base in
            cesium-man) motions=(clip:Anim_0) ;;
            green-man) motions=(clip:3_attack) ;;
        esac
    fi
    "$HAIRLOOM_CLI" colliders "$out/$base-few.hairloom" --fit "$fit" -o "$out/$name-skin.hairloom" --force --json \
        > "$out/$name-fit.json" 2> "$out/$name-fit.txt"
    rm -f "$out/$name"-{clip,nod,spin,stop}.json
    for motion in "${motions[@]}"; do
        what=$(basename "${motion%%:*}" .json)
        wind=(--wind 3,0,0)
        [ "$what" != stop ] || wind=()
        "$HAIRLOOM_CLI" simulate "$out/$name-skin.hairloom" --frames 60 --fps 60 "${wind[@]}" --motion "$motion" --json \
            > "$out/$name-$what.json" 2> "$out/$name-$what.txt"
    done
done
table=$out/table.md
python3 - "$out" "${names[@]}" > "$table" <<'PY'
import json, os, sys
out, *names = sys.argv[1:]
print("| hair | clip | nod | spin | dead stop | authored | worst gap | kB |\n|---|---|---|---|---|---|---|---|")
for name in names:
    cells, authored = [], 0
    for motion in ("clip", "nod", "spin", "stop"):
        file = f"{out}/{name}-{motion}.json"
        report = json.load(open(file)) if os.path.exists(file) else None
        cells.append(f"{report['max_mesh_penetration_mm']:.1f} ({report['max_guide_penetration_mm']:.1f})" if report else "")
        authored = report["authored_depth_mm"] if report else authored
    fit = json.load(open(f"{out}/{name}-fit.json"))
    size = f"{fit['bytes'] / 1000:.0f}" if "bytes" in fit else ""
    print(f"| {name.replace('+', ', ')} | {' | '.join(cells)} | {authored:.1f} | {fit['worst_gap_mm']:.1f} | {size} |")
PY
cat "$table"
[ -z "$page" ] || samples/put_table.sh "$table" "$page"
[ -n "$all" ] || exit 0
"$HAIRLOOM_CLI" bench contact --force -o "$out/marks" > "$out/marks.txt"
cat "$out/marks/contact.md"
[ -z "$page" ] || samples/put_table.sh "$out/marks/contact.md" "$page" marks
