#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# measure_accuracy.sh OUT [PICTURES]: work-precision runs of the sample hairstyles, of one with hair soft enough for
# explicit integrators, and of Sintel's where ../shared/data has her, into OUT/NAME; their drawings are copied to
# PICTURES/accuracy-NAME.svg and accuracy-NAME-parts.svg where that folder is named. docs/accuracy.md tells how to read
# them.
set -euo pipefail

top=$(cd "$(dirname "$(readlink -f "$0")")/.." && pwd)
mkdir -p "${1:?a folder for the results}"
out=$(cd "$1" && pwd)
pictures=${2:+$(cd "$2" && pwd)}
cli=${HAIRLOOM_CLI:-$top/build/release/bin/hairloom-cli}

# measure NAME OPTION…
measure() {
    local name=$1
    shift
    "$cli" accuracy "$out/$name.hairloom" -o "$out/$name" --wind "$wind" --frames 60 --fps 30 --repeat 3 "$@"
    [ -n "$pictures" ] || return 0
    cp "$out/$name/work_precision.svg" "$pictures/accuracy-$name.svg"
    cp "$out/$name/error_parts.svg" "$pictures/accuracy-$name-parts.svg"
}
clip=(--motion clip:nod_and_turn --points 8,16,24)

cd "$top"
for style in short shoulder long; do
    # shellcheck source=/dev/null
    . "samples/hairstyles/$style.conf"
    samples/make_hairstyle.sh --project-only --spheres-only "$style" "$out"
    measure "$style" "${clip[@]}" --substeps 1,2,3,4,8,16 --vary strandModel=rods,springs
    if [ "$style" = shoulder ]; then
        "$cli" set "$out/shoulder.hairloom" simulation.strandModel=springs simulation.angularStiffness=0.1 \
            simulation.bendDampingTime=0 -o "$out/shoulder-soft.hairloom"
        measure shoulder-soft "${clip[@]}" --integrators verlet,velocityVerlet,leapfrog,explicitEuler,implicitEuler,rk4 \
            --substeps 1,2,4,8,16,32 --iterations 1,2
    fi
done
data=../shared/data
if [ -f "$data/strands/sintel_16pt.tfx" ]; then
    wind=2,0,0
    "$cli" import "$data/strands/sintel_16pt.tfx" --mesh "$data/heads/sintel.obj" -o "$out/sintel.hairloom"
    measure sintel --motion nod --points 4,8,16 --substeps 1,2,4,8,16 --vary strandModel=rods,springs
fi
