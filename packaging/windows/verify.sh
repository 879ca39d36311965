#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds for Windows and verifies the result under Wine; `./dev windows` runs it once the packages are installed. The table
# that it prints last is also in build/windows/verified.md.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../.."
export HAIRLOOM_CACHE=${HAIRLOOM_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/hairloom}
export HAIRLOOM_WINDOWS_SYSROOT=$HAIRLOOM_CACHE/windows
out=$PWD/build/windows
wine=$PWD/packaging/windows/wine.sh

say() { printf '\033[1m%s\033[0m\n' "$*" >&2; }

# withDisplay RENDERER COMMAND…: Wine draws Direct3D through OpenGL (gl) or Vulkan (vulkan).
withDisplay() {
    local renderer=$1
    shift
    WINE_D3D_CONFIG=renderer=$renderer xvfb-run -a -s "-screen 0 1280x1024x24" "$@"
}

rows=()
failures=0
# check WHAT BACKEND COMMAND…: runs it and adds a row to the table.
check() {
    local what=$1 backend=$2 result=passed
    shift 2
    say "$what, $backend"
    "$@" || { result=FAILED; failures=$((failures + 1)); }
    rows+=("| $what | $backend | $result |")
}

tests() { ctest --test-dir "$out" --output-on-failure -j 2 "$@"; }

# pictureOf RENDERER BACKEND STYLE
pictureOf() {
    withDisplay "$1" "$wine" "$out/bin/hairloom-cli.exe" render "$out/pictures/$3.hairloom" --size 512x512 \
        --camera three-quarter --exposure 1.6 --backend "$2" -o "$out/pictures/$3-$2-$1.png" > /dev/null
}

# likeVulkan RENDERER STYLE: the picture of Direct3D 11, through Wine's RENDERER, against the one of Vulkan. Root mean
# square of the differences, of 1; what the eye takes for the same stays below 0.02.
likeVulkan() {
    pictureOf "$1" d3d11 "$2" || return
    local difference
    difference=$(compare -metric RMSE "$out/pictures/$2-vulkan-gl.png" "$out/pictures/$2-d3d11-$1.png" null: 2>&1 |
                 sed 's/.*(\(.*\)).*/\1/')
    say "difference $difference"
    awk -v d="$difference" 'BEGIN { exit !(d < 0.02) }'
}

archives=${HAIRLOOM_WINDOWS_ARCHIVES:-../shared/windows-sysroot}
packaging/windows/sysroot.sh "$HAIRLOOM_WINDOWS_SYSROOT" "$archives"
cmake --preset windows >&2
cmake --build build/windows -j "$(nproc)" >&2

check "tests without a GPU" "–" tests -LE 'gpu|render'
for renderer in gl vulkan; do
    for label in gpu render; do
        check "tests of core/$label" "Direct3D 11 (Wine, $renderer)" withDisplay "$renderer" ctest --test-dir "$out" \
            --output-on-failure -R "^$label"
    done
done

mkdir -p "$out/pictures"
printf '#!/bin/sh\nexec "%s" "%s" "$@"\n' "$wine" "$out/bin/hairloom-cli.exe" > "$out/bin/cli-under-wine"
chmod +x "$out/bin/cli-under-wine"
for style in short shoulder long; do
    HAIRLOOM_CLI="$out/bin/cli-under-wine" check "making the sample '$style'" "–" \
        samples/make_hairstyle.sh --project-only "$style" "$out/pictures"
    check "simulating '$style'" "CPU" "$wine" "$out/bin/hairloom-cli.exe" simulate "$out/pictures/$style.hairloom" \
        --frames 10 --fps 30 --motion clip:nod_and_turn --record "$out/pictures/$style.frames"
    check "picture of '$style'" "Vulkan (Wine)" pictureOf gl vulkan "$style"
    for renderer in gl vulkan; do
        check "picture of '$style' is Vulkan's" "Direct3D 11 (Wine, $renderer)" likeVulkan "$renderer" "$style"
    done
done

{
    printf '| what | backend | result |\n|---|---|---|\n'
    printf '%s\n' "${rows[@]}"
} | tee "$out/verified.md"
[ "$failures" -eq 0 ] || { say "$failures of ${#rows[@]} failed"; exit 1; }
