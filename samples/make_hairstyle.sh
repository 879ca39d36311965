#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# make_hairstyle.sh [--project-only] STYLE OUT: makes one of the sample hairstyles from nothing into the folder OUT and
# says what each step took. STYLE names a file of samples/hairstyles. --project-only stops before anything is simulated,
# exported or drawn. The programs must be built (./dev build).
set -euo pipefail

project_only=no
if [ "${1-}" = --project-only ]; then project_only=yes; shift; fi
style=${1:?a style: short, shoulder, long, bob, afro or braid}
top=$(cd "$(dirname "$(readlink -f "$0")")/.." && pwd)
mkdir -p "${2:?a folder for the results}"
out=$(cd "$2" && pwd)
cli=${HAIRLOOM_CLI:-$top/build/release/bin/hairloom-cli}
[ -f "$top/samples/hairstyles/$style.conf" ] || { echo "error: no style '$style' in samples/hairstyles" >&2; exit 2; }

# scalp, count, length, follow: set by the style
# shellcheck source=/dev/null
. "$top/samples/hairstyles/$style.conf"

step() {
    local what=$1 begin=$EPOCHREALTIME
    shift
    "$cli" "$@" >"$out/log.txt" || { cat "$out/log.txt" >&2; echo "error: step '$what' failed" >&2; exit 1; }
    awk -v what="$what" -v a="$begin" -v b="$EPOCHREALTIME" 'BEGIN { printf "  %-52s %7.2f s\n", what, b - a }'
}

cd "$top"   # so that the project names its character file from the top of the repository
echo "Making the sample '$style':"
step "head, scalp, roots, strands" create --mesh samples/bust/bust.glb --scalp "$scalp" --count "$count" \
    --placement dart --length "$length" --points 24 --seed 1 -o "$out/$style.hairloom"
step "grooming" groom "$out/$style.hairloom" --script "samples/hairstyles/$style.json" -o "$out/$style.hairloom"
step "collision spheres" spheres "$out/$style.hairloom" --from samples/bust/spheres.json --replace -o "$out/$style.hairloom"
step "simulation and material settings" set "$out/$style.hairloom" --from "samples/hairstyles/$style.settings.json" \
    -o "$out/$style.hairloom"
if [ "$project_only" = no ]; then
    step "two seconds of head motion in wind" simulate "$out/$style.hairloom" --frames 60 --fps 30 \
        --motion clip:nod_and_turn --wind "$wind" --record "$out/$style.frames"
    step "asset: Yuksel .hair" export "$out/$style.hairloom" --format hair -o "$out/$style.hair"
    step "asset: TressFX .tfx" export "$out/$style.hairloom" --format tfx -o "$out/$style.tfx"
    step "picture at rest" render "$out/$style.hairloom" --size 1024x1024 --camera three-quarter --exposure 1.6 -o "$out/$style.png"
    step "picture in motion" render "$out/$style.hairloom" --record "$out/$style.frames" --frame 12 --size 1024x1024 \
        --camera three-quarter --exposure 1.6 -o "$out/$style-motion.png"
fi
rm -f "$out/log.txt"
echo "Results in $out:"
ls -l "$out" | awk -v style="$style" '$9 ~ "^" style { printf "  %-40s %9.1f kB\n", $9, $5 / 1024 }'
