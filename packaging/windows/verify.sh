#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: packaging/windows/verify.sh [--all | --core]
# Builds for Windows and verifies the result under Wine, on a display without a screen; `./dev windows` runs it once the
# packages are installed. Each step adds a line to build/windows/results.tsv: what, backend, result, measured, seconds; the
# table made of them is printed last and stays in build/windows/verified.md. What a step said is in build/windows/verify/.
# --all adds the samples of medium and long hair and the hard cases through both of Wine's renderers, and writes the table into
# packaging/windows/verified.md when all of it passed. --core leaves out the editor and the tests of whole pictures, which take
# most of the time to build. With CI in the environment some sources are compiled at a time, which is faster once.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../.."
# -noreset: else the server turns clients away while it begins anew after its last one left.
[ -n "${HAIRLOOM_ON_XVFB:-}" ] ||
    HAIRLOOM_ON_XVFB=1 exec xvfb-run -a -s "-screen 0 1600x1000x24 -noreset" packaging/windows/verify.sh "$@"
export HAIRLOOM_CACHE=${HAIRLOOM_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/hairloom}
export HAIRLOOM_WINDOWS_SYSROOT=$HAIRLOOM_CACHE/windows
out=$PWD/build/windows
results=$out/results.tsv
said=$out/verify
pictures=$out/pictures
screenshots=$out/screenshots
wine=$PWD/packaging/windows/wine.sh
limits=$PWD/packaging/windows/limits-of-wine.txt
styles=(short)
extent=${1:-}
[ "$extent" != --all ] || styles=(short shoulder long)
# Rooms whose tests count here: what asks the system, what the compiler makes other code of, and what draws. The others are
# the same code as on Linux.
on_cpu=(base runtime importers)
on_gpu=(gpu gpu_window gpu_simulation render golden)
programs=(hairloom-cli hairloom-mesh-reader hairloom-window hairloom test_editor)
libraries=()
with_editor=ON
if [ "$extent" = --core ]; then
    on_cpu=(base runtime importers)
    on_gpu=(gpu gpu_window gpu_simulation)
    programs=(hairloom-cli hairloom-mesh-reader hairloom-window)
    libraries=(--without-qt)
    with_editor=OFF
fi

say() { printf '\033[1m%s\033[0m\n' "$*" >&2; }

steps=0
failures=0
# result WHAT BACKEND RESULT MEASURED SECONDS
result() { (IFS=$'\t'; printf '%s\n' "$*" >> "$results"); }
# check WHAT BACKEND COMMAND…: runs it and adds a line to the results. What the command measures it leaves in $said/measured.
check() {
    local what=$1 backend=$2 outcome=passed start=$SECONDS log measured
    shift 2
    steps=$((steps + 1))
    log=$said/$(printf '%02d-%s-%s' "$steps" "$what" "$backend" | tr -cs 'a-zA-Z0-9-' '_').txt
    : > "$said/measured"
    "$@" > "$log" 2>&1 || { outcome=FAILED; failures=$((failures + 1)); tail -30 "$log" >&2; }
    measured=$(cat "$said/measured")
    say "$outcome: $what, $backend${measured:+: $measured} ($((SECONDS - start)) s)"
    result "$what" "$backend" "$outcome" "$measured" $((SECONDS - start))
}
measured() { printf '%s' "$*" > "$said/measured"; }

# underWine PROGRAM LAST ARGUMENT…: passes when the program ends with 0, within half an hour. Wine's server kills a program that is
# not gone a second after its end, too short for drivers on a busy machine: then the last line it prints, LAST, has to be there.
underWine() {
    local program=$1 last=$2 status=0 printed=$said/printed.txt
    shift 2
    timeout 1800 "$wine" "$out/bin/$program.exe" "$@" > "$printed" || status=$?
    cat "$printed"
    [ "$status" -ne 124 ] || echo "error: not at its end after half an hour"
    [ "$status" -eq 0 ] || { [ "$status" -eq 137 ] && grep -q "$last" "$printed"; }
}
# Jobs print their report when they are done.
cli() { underWine hairloom-cli . "$@"; }

# roomTests ROOM LIMIT [FILTER]: all tests of the room, which has to come to its end. What limits-of-wine.txt lists under LIMIT
# may fail, and nothing else.
roomTests() {
    local room=$1 limit=$2 printed=$said/printed.txt test known=0 unknown=0
    underWine "test_$room" '^\[==========\] .* ran\.' "--gtest_filter=${3:-*}" || true
    grep -q '^\[==========\] .* ran\.' "$printed" || { echo "error: the tests did not come to their end"; return 1; }
    while read -r test; do
        if grep -q "^$limit $room $test: ." "$limits"; then
            known=$((known + 1))
            grep "^$limit $room $test: ." "$limits"
        else
            unknown=$((unknown + 1))
            echo "error: $test failed"
        fi
    done < <(sed -n 's/^\[  FAILED  \] \([^ ,]*\).* ([0-9]* ms).*/\1/p' "$printed")
    measured "$(sed -n 's/^\[  PASSED  \] \([0-9]*\) test.*/\1 passed/p' "$printed")$(
        sed -n 's/^\[  SKIPPED \] \([0-9]*\) test.*/, \1 skipped/p' "$printed")$(
        [ "$known" -eq 0 ] || echo ", $known fail as listed")$(
        [ "$unknown" -eq 0 ] || echo ", $unknown fail")"
    [ "$unknown" -eq 0 ] && grep -q '^\[  PASSED  \] [1-9]' "$printed"
}
listsDirect3D() { cli devices --json | tee /dev/stderr | grep -q '"Direct3D 11"'; }

# pictureOf BACKEND FILE PICTURE
pictureOf() {
    cli render "$pictures/$2" --size 320x320 --passes 4 --camera three-quarter --exposure 1.6 \
        --ribbons strip --backend "$1" -o "$3"
}

# likeVulkan FILE MOST PICTURE: draws it with Direct3D and compares. Root mean square of the differences, of 1, which stays
# below MOST.
likeVulkan() {
    pictureOf d3d11 "$1" "$3" || return
    local difference
    difference=$(compare -metric RMSE "$pictures/$1-vulkan.png" "$3" null: 2>&1 | sed 's/.*(\(.*\)).*/\1/')
    measured "$(printf 'differs by %.5f' "$difference")"
    awk -v d="$difference" -v most="$2" 'BEGIN { exit !(d < most) }'
}

# amongSpheres STYLE: the hairstyle without its skin collider, which no kernel for Direct3D 11 knows, and its motion on the CPU.
amongSpheres() {
    cli colliders "$pictures/$1.hairloom" --fit none -o "$pictures/$1-spheres.hairloom" &&
        cli simulate "$pictures/$1-spheres.hairloom" --frames 4 --fps 30 --motion clip:nod_and_turn \
            --record "$pictures/$1-spheres.frames"
}

# onDirect3D PROJECT OPTION…: four frames of it.
onDirect3D() { cli simulate "$pictures/$1.hairloom" --frames 4 --fps 30 --motion clip:nod_and_turn --backend d3d11 "${@:2}"; }

# refusesSkin STYLE: hair that would pass through its skin is not simulated, and you are told why.
refusesSkin() {
    local told
    if told=$(onDirect3D "$1" 2>&1); then return 1; fi
    printf '%s\n' "$told"
    grep -q 'Direct3D 11 does not keep hair out of the skin' <<< "$told"
}

# nearTheCpu STYLE: the device's motion beside that of the engine on the CPU, which knows more effects
# (docs/gpu-simulation.md): the root mean square of the distances stays below 5 mm, and every point is a number. What the
# kernels have to hold to is in the tests of gpu_simulation.
nearTheCpu() {
    local report
    report=$(onDirect3D "$1-spheres" --against "$pictures/$1-spheres.frames" --json) || return
    printf '%s\n' "$report"
    measured "$(printf '%s\n' "$report" | awk -F: '/"error_mm":/ { printf "%.2f mm from the CPU", $2 }')"
    printf '%s\n' "$report" | awk -F: '/"error_mm":/ { near = $2 + 0 < 5 && $2 !~ /null/ } /"nan_count":/ { sound = $2 + 0 == 0 }
                                       END { exit !(near && sound) }'
}

# findsAnyName STYLE: a hairstyle is exported to, and imported from, names outside ASCII, of two and of four bytes a letter.
findsAnyName() {
    local folder=$pictures/Zöpfe-💇
    mkdir -p "$folder" && cp "$pictures/$1.hairloom" "$folder/Frisür.hairloom" || return
    cli validate "$folder/Frisür.hairloom" && cli export "$folder/Frisür.hairloom" --format hair -o "$folder/髪.hair" &&
        cli import "$folder/髪.hair" -o "$folder/zurück.hairloom" && [ -s "$folder/zurück.hairloom" ]
}

# guardsForeignFiles: of each layer of the process that reads them it is said whether it is set, and none could not be set. One that is
# set refuses what it is for. Wine 8 tells no limits of jobs and knows no integrity: they are missing there.
guardsForeignFiles() {
    local told
    told=$(cli devices --security --json) || return
    printf '%s\n' "$told"
    measured "$(printf '%s\n' "$told" | sed -n 's/.*"layer_\([a-z]*\)": *"\([a-z]*\)".*/\1 \2/p' | paste -sd ,)"
    printf '%s\n' "$told" | awk -F '"' '/"layer_/ { layers++; state[substr($2, 7)] = $4 }
                                      /"refuses_/ { refuses[substr($2, 9)] = $3 ~ /true/ }
                                      END { for (l in state) bad += state[l] == "failed"
                                            for (l in refuses) bad += state[l] == "set" && !refuses[l]
                                            exit !(layers == 3 && !bad) }'
}

# readsPictures STYLE: a picture of each kind goes through that process.
readsPictures() {
    convert -size 24x16 gradient:red-blue "$pictures/picture.png" &&
        cli set "$pictures/$1.hairloom" --dye-image "$pictures/picture.png" -o "$pictures/dyed.hairloom" &&
        cli render "$pictures/dyed.hairloom" --size 16x16 --passes 1 --exr "$pictures/sky.exr" -o "$pictures/small.png" || return
    printf '{"lights": [{"type": "environment", "image": "sky.%s"}]}' exr > "$pictures/exr.json"
    printf '{"lights": [{"type": "environment", "image": "sky.%s"}]}' jpg > "$pictures/jpg.json"
    convert -size 16x8 gradient:blue-white "$pictures/sky.jpg" &&
        cli render "$pictures/$1.hairloom" --size 16x16 --passes 1 --view "$pictures/exr.json" -o "$pictures/sky.png" || return
    # Without libjpeg that is what it says.
    cli render "$pictures/$1.hairloom" --size 16x16 --passes 1 --view "$pictures/jpg.json" -o "$pictures/jpg.png" ||
        cli render "$pictures/$1.hairloom" --size 16x16 --passes 1 --view "$pictures/jpg.json" -o "$pictures/jpg.png" 2>&1 |
        grep -i 'JPEG'
}

# walkThroughTheEditor: the viewport is a window of its own there, because Wine shows no device's picture within another.
walkThroughTheEditor() {
    HAIRLOOM_VIEWPORT=apart roomTests editor none 'WalkTest.*:PictureTest.AWindow*'
}

# buildsDirect3D: samples/direct3d by what is installed of the runtime alone, and beside Microsoft's compiler.
buildsDirect3D() {
    rm -rf "$out/direct3d" "$out/direct3d-prefix"
    cmake --install "$out" --component runtime --prefix "$out/direct3d-prefix" &&
        cmake -S samples/direct3d -B "$out/direct3d" -G Ninja -DCMAKE_BUILD_TYPE=Release "-DCMAKE_RUNTIME_OUTPUT_DIRECTORY=$out/bin" \
            "-DCMAKE_TOOLCHAIN_FILE=$PWD/packaging/windows/mingw64.cmake" "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror -D_WIN32_WINNT=0x0A00" \
            "-Dhairloom-runtime_DIR=$(dirname "$(find "$out/direct3d-prefix" -name hairloom-runtime-config.cmake)")" &&
        cmake --build "$out/direct3d"
}

# playsOnDirect3D STYLE OPTION…: its hairs lie where the CPU has them.
playsOnDirect3D() {
    local asset=$pictures/$1.hairrt
    [ -f "$asset" ] || cli export "$pictures/$1-spheres.hairloom" --format runtime -o "$asset" || return
    underWine direct3d_hair '^as expected' "$asset" "$out/direct3d-prefix/share/hairloom-runtime/shaders" --check "${@:2}" || return
    measured "$(tr -d '\r' < "$said/printed.txt" | sed -n "s/^apart from the CPU's: //p")"
}

rm -rf "$said" "$pictures" "$screenshots" "$results"
mkdir -p "$said" "$pictures" "$screenshots"
archives=${HAIRLOOM_WINDOWS_ARCHIVES:-../shared/windows-sysroot}
packaging/windows/sysroot.sh "${libraries[@]}" "$HAIRLOOM_WINDOWS_SYSROOT" "$archives"
result "building the libraries" CPU passed "" "$SECONDS"
start=$SECONDS
cmake --preset windows -DHAIRLOOM_EDITOR="$with_editor" ${CI:+-DCMAKE_UNITY_BUILD=ON} >&2
cmake --build build/windows -j "$(nproc)" --target "${programs[@]}" "${on_cpu[@]/#/test_}" "${on_gpu[@]/#/test_}" >&2
result "building Hairloom" CPU passed "" $((SECONDS - start))

printf '#!/bin/sh\nexec "%s" "%s" "$@"\n' "$wine" "$out/bin/hairloom-cli.exe" > "$out/bin/cli-under-wine"
chmod +x "$out/bin/cli-under-wine"
for style in "${styles[@]}"; do
    HAIRLOOM_CLI=$out/bin/cli-under-wine check "making the sample '$style'" "CPU" \
        samples/make_hairstyle.sh --project-only "$style" "$pictures"
    check "simulating '$style'" "CPU" cli simulate "$pictures/$style.hairloom" --frames 4 --fps 30 \
        --motion clip:nod_and_turn
    check "'$style' without its skin collider" "CPU" amongSpheres "$style"
    check "picture of '$style'" "Vulkan" pictureOf vulkan "$style.hairloom" "$pictures/$style.hairloom-vulkan.png"
    check "exporting '$style'" "CPU" cli export "$pictures/$style.hairloom" --format hair -o "$pictures/$style.hair"
    check "strands of '$style' alone" "Vulkan" pictureOf vulkan "$style.hair" "$pictures/$style.hair-vulkan.png"
done
check "files of any name" "CPU" findsAnyName short
check "guard of foreign files" "CPU" guardsForeignFiles
check "pictures as inputs" "Vulkan" readsPictures short

check "samples/window" "Vulkan" tests/samples/window_screenshot.sh "$screenshots/window-vulkan.png" \
    "$wine" "$out/bin/hairloom-window.exe" shoulder --guides --backend vulkan --width 480 --height 480

check "samples/direct3d builds" "CPU" buildsDirect3D
check "clang 14 on the sources for Windows" "CPU" packaging/windows/clang.sh "$out"
for room in "${on_cpu[@]}"; do check "tests of $room" "CPU" roomTests "$room" none; done

# Wine turns Direct3D into OpenGL or Vulkan.
export HAIRLOOM_TEST_BACKEND=d3d11
# What one run compiles the next one finds, as with the programs themselves.
export HAIRLOOM_TEST_KERNELS=$out/kernels
for renderer in gl vulkan; do
    export WINE_D3D_CONFIG=renderer=$renderer
    case $renderer in gl) backend="Direct3D 11 by OpenGL" ;; vulkan) backend="Direct3D 11 by Vulkan" ;; esac
    check "hairloom-cli devices" "$backend" listsDirect3D
    for style in "${styles[@]}"; do
        check "simulating '$style'" "$backend" nearTheCpu "$style"
        check "skin of '$style' is refused" "$backend" refusesSkin "$style"
        # Hairs of a hairstyle are more than a buffer of the least device holds. Their numbers begin anew in each, and their random
        # samples go by them: what the eye takes for the same stays below 0.02. Strands of one buffer have the same samples.
        check "picture of '$style'" "$backend" likeVulkan "$style.hairloom" 0.02 "$pictures/$style-d3d11-$renderer.png"
        check "strands of '$style' alone" "$backend" likeVulkan "$style.hair" 0.001 "$pictures/$style-strands-d3d11-$renderer.png"
    done
    check "samples/direct3d" "$backend" playsOnDirect3D short -o "$pictures/direct3d-$renderer.ppm" --frames 10
    check "samples/direct3d, shaded" "$backend" playsOnDirect3D short -o "$pictures/direct3d-shaded-$renderer.ppm" --frames 5 --shade
    check "samples/window" "$backend" tests/samples/window_screenshot.sh "$screenshots/window-d3d11-$renderer.png" \
        "$wine" "$out/bin/hairloom-window.exe" shoulder --guides --backend d3d11 --width 480 --height 480
    if [ "$with_editor" = ON ]; then
        check "hairloom.exe starts" "$backend" underWine hairloom . --quit-when-shown
        check "the editor's walk, live viewport" "$backend" walkThroughTheEditor
    fi
    for room in "${on_gpu[@]}"; do check "tests of $room" "$backend" roomTests "$room" "$renderer" '-*HardCases.*'; done
    # They compile a kernel each, which takes the most of the time: through one renderer, or both with --all.
    if [ "$extent" = --all ] || [ "$extent$renderer" = vulkan ]; then
        check "hard cases on the device" "$backend" roomTests gpu_simulation "$renderer" '*HardCases.*'
    fi
done

packaging/windows/table.sh "$results" | tee "$out/verified.md"
say "done in $SECONDS s"
[ "$failures" -eq 0 ] || { say "$failures of $steps failed"; exit 1; }
[ "$extent" != --all ] || packaging/windows/table.sh "$results" packaging/windows/verified.md
