#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes the pictures of docs/manual.md anew, from the window on a display of its own. Takes ImageMagick, and half an hour without
# a GPU.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../.."
out=$PWD/out/manual
mkdir -p "$out"
HAIRLOOM_VIEWPORT=readback HAIRLOOM_MANUAL="$out" xvfb-run -a -s "-screen 0 1600x1000x24 -noreset" \
    build/release/bin/test_editor --gtest_filter='ManualTest.*:GroomerWalkTest.*:StyleWalkTest.*'
for picture in "$out"/editor-*.png; do
    convert "$picture" -colors 256 "png8:docs/pictures/${picture##*/}"
done
