#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# make_figure5.sh OUT: the set-up of Figure 5 of the thesis, from nothing into the folder OUT. 180 guides of 10 segments, with 30
# neighbours each and drawn themselves (5,580 hairs), fall over collision spheres with a radius of 0 around points and impulsive
# responses, shaded by Sadeghi's model. Writes the project, its motion and a strip of four pictures. The programs must be built
# (./dev build).
set -euo pipefail

top=$(cd "$(dirname "$(readlink -f "$0")")/.." && pwd)
mkdir -p "${1:?a folder for the results}"
out=$(cd "$1" && pwd)
cli=${HAIRLOOM_CLI:-$top/build/release/bin/hairloom-cli}
project=$out/figure5.hairloom

cd "$top"   # so that the project names its character file from the top of the repository
"$cli" create --mesh samples/bust/bust.glb --scalp material:scalp --count 180 --placement dart --length 0.28 \
    --points 11 --seed 5 -o "$project" >/dev/null
"$cli" spheres "$project" --from samples/bust/spheres.json --replace -o "$project" >/dev/null
"$cli" set "$project" interpolation.followPerGuide=31 interpolation.drawGuides=1 interpolation.blend=0 \
    interpolation.wispRadiusRoot=0.006 interpolation.wispRadiusTip=0.012 material.shadingModel=sadeghi material.rootRadius=0.00009 \
    simulation.strandModel=springs simulation.substeps=8 simulation.collisionResponse=radial simulation.collisionRadiusRoot=0 \
    simulation.collisionRadiusTip=0 simulation.angularStiffness=0.15 -o "$project" >/dev/null
"$cli" simulate "$project" --frames 40 --fps 30 --motion none --record "$out/figure5.frames"
"$cli" render "$project" --record "$out/figure5.frames" --frames 0,30,10 --strip "$out/figure5-strip.png" --columns 4 \
    --size 400x400 --camera three-quarter --exposure 1.6 -o "$out/figure5.png"
