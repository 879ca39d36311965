#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# make_thesis.sh: makes pictures of docs/thesis.md after figures of the thesis: Figure 9, 90 guides whose hairs follow one guide
# (left) and three (right). `samples/make_figure5.sh` has Figure 5. The programs must be built (./dev build), and ImageMagick
# installed.
set -euo pipefail

top=$(cd "$(dirname "$(readlink -f "$0")")/../.." && pwd)
cli=${HAIRLOOM_CLI:-$top/build/release/bin/hairloom-cli}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$top"
for blend in 0 1; do
    project=$work/blend$blend.hairloom
    "$cli" create --mesh samples/bust/bust.glb --scalp material:scalp --count 90 --placement dart --length 0.24 --points 16 \
        --seed 5 -o "$project" >/dev/null
    "$cli" spheres "$project" --from samples/bust/spheres.json --replace -o "$project" >/dev/null
    "$cli" set "$project" interpolation.followPerGuide=60 interpolation.blend=$blend interpolation.wispRadiusRoot=0.003 \
        interpolation.wispRadiusTip=0.006 material.shadingModel=sadeghi material.rootRadius=0.0001 simulation.restGravity=0 \
        simulation.angularStiffness=0.05 -o "$project" >/dev/null
    "$cli" simulate "$project" --frames 120 --fps 30 --motion none --record "$work/blend$blend.frames" >/dev/null
    "$cli" render "$project" --record "$work/blend$blend.frames" --frame 119 --size 480x480 --camera three-quarter \
        --exposure 1.8 -o "$work/blend$blend.png" >/dev/null
done
convert "$work/blend0.png" "$work/blend1.png" +append "$top/docs/pictures/figure-9.png"
