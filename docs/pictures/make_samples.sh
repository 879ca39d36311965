#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes docs/pictures/samples.png anew, all sample hairstyles, and shoulder.png, one at rest and in motion. Takes
# ImageMagick, and half an hour without a GPU.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../.."
cli=build/release/bin/hairloom-cli
out=out/samples
mkdir -p "$out"

# draw STYLE CAMERA SIZE NAME [OPTION...]
draw() {
    "$cli" render "$out/$1.hairloom" --camera "$2" --size "$3" --exposure 1.6 -o "$out/$4.png" "${@:5}" > "$out/log.txt"
}

for style in short shoulder long bob afro braid; do
    samples/make_hairstyle.sh --project-only "$style" "$out"
    camera=three-quarter
    if [ "$style" = braid ]; then camera=back; fi
    draw "$style" "$camera" 380x460 "$style"
done
"$cli" simulate "$out/shoulder.hairloom" --frames 60 --fps 30 --motion clip:nod_and_turn --wind 2.5,0,1.5 \
    --record "$out/shoulder.frames" > "$out/log.txt"
draw shoulder three-quarter 760x760 rest
draw shoulder three-quarter 760x760 motion --record "$out/shoulder.frames" --frame 12

convert "$out"/{short,shoulder,long}.png +append +repage "$out/upper.png"
convert "$out"/{bob,afro,braid}.png +append +repage "$out/lower.png"
convert "$out"/{upper,lower}.png -append +repage -colors 256 png8:docs/pictures/samples.png
convert "$out"/{rest,motion}.png +append +repage -define png:compression-level=9 docs/pictures/shoulder.png
