#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# measure_accuracy.sh OUT [PICTURES]: work-precision runs of the sample hairstyles, into OUT/STYLE; their drawings are
# copied to PICTURES/accuracy-STYLE.svg where that folder is named. docs/accuracy.md tells how to read them.
set -euo pipefail

top=$(cd "$(dirname "$(readlink -f "$0")")/.." && pwd)
mkdir -p "${1:?a folder for the results}"
out=$(cd "$1" && pwd)
pictures=${2:+$(cd "$2" && pwd)}
cli=${HAIRLOOM_CLI:-$top/build/release/bin/hairloom-cli}

cd "$top"
for style in short shoulder long; do
    # shellcheck source=/dev/null
    . "samples/hairstyles/$style.conf"
    samples/make_hairstyle.sh --project-only "$style" "$out"
    "$cli" accuracy "$out/$style.hairloom" -o "$out/$style" --motion clip:nod_and_turn --wind "$wind" \
        --frames 60 --fps 30 --integrators verlet,velocityVerlet,leapfrog,explicitEuler,implicitEuler,rk4 \
        --substeps 1,2,4,8,16,32 --iterations 1,2 --points 8,16,24 --repeat 3
    [ -z "$pictures" ] || cp "$out/$style/work_precision.svg" "$pictures/accuracy-$style.svg"
done
