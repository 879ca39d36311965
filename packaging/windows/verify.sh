#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: packaging/windows/verify.sh
# Builds for Windows and verifies the result under Wine, on a display without a screen; `./dev windows` runs it once the
# packages are installed. The table that it prints last is also in build/windows/verified.md, what each step said in
# build/windows/verify/.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../.."
[ -n "${HAIRLOOM_ON_XVFB:-}" ] ||
    HAIRLOOM_ON_XVFB=1 exec xvfb-run -a -s "-screen 0 1600x1000x24" packaging/windows/verify.sh
export HAIRLOOM_CACHE=${HAIRLOOM_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/hairloom}
export HAIRLOOM_WINDOWS_SYSROOT=$HAIRLOOM_CACHE/windows
out=$PWD/build/windows
said=$out/verify
pictures=$out/pictures
screenshots=$out/screenshots
wine=$PWD/packaging/windows/wine.sh
styles=(short shoulder long)
# Rooms whose tests count here: what asks the system, what the compiler makes other code of, and what draws. The others are
# the same code as on Linux.
on_cpu=(base runtime importers)
on_gpu=(gpu gpu_window gpu_simulation render)

say() { printf '\033[1m%s\033[0m\n' "$*" >&2; }

rows=()
failures=0
# check WHAT BACKEND COMMAND…: runs it and adds a row to the table.
check() {
    local what=$1 backend=$2 result=passed start=$SECONDS log
    shift 2
    log=$said/$(printf '%02d-%s-%s' "${#rows[@]}" "$what" "$backend" | tr -cs 'a-zA-Z0-9-' '_').txt
    "$@" > "$log" 2>&1 || { result=FAILED; failures=$((failures + 1)); tail -30 "$log" >&2; }
    say "$result: $what, $backend ($((SECONDS - start)) s)"
    rows+=("| $what | $backend | $result |")
}

cli() { "$wine" "$out/bin/hairloom-cli.exe" "$@"; }
# roomTests ROOM [FILTER]
roomTests() { "$wine" "$out/bin/test_$1.exe" --gtest_brief=1 "--gtest_filter=${2:-*}"; }
# Wine 8's Vulkan renderer loses all rows but the first of textures of one byte a texel whose width is no multiple of four,
# whatever program asks; nothing here makes such textures (docs/windows.md).
flaw_of_wine=RoundTrip.RowsOfOddBytesComeBackAsTheyWent
listsDirect3D() { cli devices --json | tee /dev/stderr | grep -q '"Direct3D 11"'; }

# pictureOf BACKEND STYLE PICTURE
pictureOf() {
    cli render "$pictures/$2.hairloom" --size 320x320 --passes 4 --camera three-quarter --exposure 1.6 --backend "$1" -o "$3"
}

# likeVulkan STYLE PICTURE: draws it with Direct3D and compares. Root mean square of the differences, of 1; what the eye takes
# for the same stays below 0.02.
likeVulkan() {
    pictureOf d3d11 "$1" "$2" || return
    local difference
    difference=$(compare -metric RMSE "$pictures/$1-vulkan.png" "$2" null: 2>&1 | sed 's/.*(\(.*\)).*/\1/')
    echo "difference $difference"
    awk -v d="$difference" 'BEGIN { exit !(d < 0.02) }'
}

# likeTheCpu STYLE: the device's motion against that of the engine on the CPU. Over a third of a second no point may part from
# it by more than a tenth of a millimetre.
likeTheCpu() {
    local report
    report=$(cli simulate "$pictures/$1.hairloom" --frames 10 --fps 30 --motion clip:nod_and_turn --backend d3d11 \
        --against "$pictures/$1.frames" --json) || return
    printf '%s\n' "$report"
    printf '%s\n' "$report" | awk -F: '/"error_mm_max"/ { found = 1; near = $2 + 0 < 0.1 } END { exit !(found && near) }'
}

# walkThroughTheEditor: the viewport is a window of its own there, because Wine shows no device's picture within another.
walkThroughTheEditor() {
    HAIRLOOM_VIEWPORT=apart "$wine" "$out/bin/test_editor.exe" '--gtest_filter=WalkTest.*:PictureTest.AWindow*'
}

archives=${HAIRLOOM_WINDOWS_ARCHIVES:-../shared/windows-sysroot}
packaging/windows/sysroot.sh "$HAIRLOOM_WINDOWS_SYSROOT" "$archives"
start=$SECONDS
cmake --preset windows >&2
cmake --build build/windows -j "$(nproc)" --target hairloom hairloom-cli hairloom-mesh-reader hairloom-window test_editor \
    "${on_cpu[@]/#/test_}" "${on_gpu[@]/#/test_}" >&2
say "built in $((SECONDS - start)) s"
rm -rf "$said" "$pictures" "$screenshots"
mkdir -p "$said" "$pictures" "$screenshots"

check "clang 14 on the sources for Windows" "–" packaging/windows/clang.sh "$out"
for room in "${on_cpu[@]}"; do check "tests of $room" "–" roomTests "$room"; done

printf '#!/bin/sh\nexec "%s" "%s" "$@"\n' "$wine" "$out/bin/hairloom-cli.exe" > "$out/bin/cli-under-wine"
chmod +x "$out/bin/cli-under-wine"
for style in "${styles[@]}"; do
    HAIRLOOM_CLI=$out/bin/cli-under-wine check "making the sample '$style'" "–" \
        samples/make_hairstyle.sh --project-only "$style" "$pictures"
    check "simulating '$style'" "CPU" cli simulate "$pictures/$style.hairloom" --frames 10 --fps 30 \
        --motion clip:nod_and_turn --record "$pictures/$style.frames"
    check "picture of '$style'" "Vulkan" pictureOf vulkan "$style" "$pictures/$style-vulkan.png"
done

# Wine turns Direct3D into OpenGL or Vulkan.
export HAIRLOOM_TEST_BACKEND=d3d11
for renderer in gl vulkan; do
    export WINE_D3D_CONFIG=renderer=$renderer
    backend="Direct3D 11 ($renderer)"
    check "hairloom-cli devices" "$backend" listsDirect3D
    for room in "${on_gpu[@]}"; do
        what="tests of $room" filter=*
        [ "$room-$renderer" != gpu-vulkan ] || { what+=" but for a flaw of Wine's"; filter=-$flaw_of_wine; }
        check "$what" "$backend" roomTests "$room" "$filter"
    done
    for style in "${styles[@]}"; do
        check "simulating '$style' as the CPU does" "$backend" likeTheCpu "$style"
        check "picture of '$style' is Vulkan's" "$backend" likeVulkan "$style" "$pictures/$style-d3d11-$renderer.png"
    done
    check "samples/window" "$backend" tests/samples/window_screenshot.sh "$screenshots/window-d3d11-$renderer.png" \
        "$wine" "$out/bin/hairloom-window.exe" shoulder --guides --backend d3d11 --width 480 --height 480
done
export WINE_D3D_CONFIG=renderer=gl
check "hairloom.exe starts" "Direct3D 11 (gl)" "$wine" "$out/bin/hairloom.exe" --quit-when-shown
check "the editor's walk, live viewport" "Direct3D 11 (gl)" walkThroughTheEditor

{
    printf '| what | backend | result |\n|---|---|---|\n'
    printf '%s\n' "${rows[@]}"
} | tee "$out/verified.md"
say "verified in $((SECONDS - start)) s"
[ "$failures" -eq 0 ] || { say "$failures of ${#rows[@]} failed"; exit 1; }
