#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# compilers.sh BUILD [NAME…]: builds the runtime, static and shared, and its single header with every compiler that is here, or
# those named; builds a C program against what is installed, by CMake and by pkg-config, and plays an asset. All machines that have
# fused multiply-add have to come to the same bits, whatever compiler and flags, and so have all that have not. Ends with a table;
# fails where something does not build, run or agree.
set -uo pipefail
top=$(cd "$(dirname "$(readlink -f "$0")")/../../.." && pwd)
mkdir -p "${1:?a folder to build in}"
build=$(cd "$1" && pwd)
shift
asset=$top/tests/exporters/files/version_1.hairrt
host=$top/tests/runtime/installed/play.c
failed=0
table=()
declare -A expected

say() { printf '%s\n' "$*" >&2; }
row() { table+=("$(printf '%-34s %s' "$1" "$2")"); say "${table[-1]}"; }
fail() { row "$1" "FAILED: $2"; failed=1; }

# judge NAME LINE: the line is what play.c prints.
judge() {
    local class=${2%% state*}
    if [[ "$2" != "fused "* ]]; then
        fail "$1" "$2"
    elif [ -z "${expected[$class]:-}" ]; then
        expected[$class]=$2
        row "$1" "ok, $class"
    elif [ "${expected[$class]}" = "$2" ]; then
        row "$1" "ok, the same bits"
    else
        fail "$1" "other bits: $2, others have ${expected[$class]}"
    fi
}

# quiet NAME COMMAND…: its output in BUILD/NAME.log, shown where it fails.
quiet() {
    local log=$build/$1.log
    shift
    "$@" > "$log" 2>&1 || { tail -5 "$log" >&2; return 1; }
}

cat > "$build/CMakeLists.txt" <<TEXT
cmake_minimum_required(VERSION 3.25)
project(host C)
find_package(hairloom-runtime 0.2 REQUIRED)
add_executable(host "$host")
target_link_libraries(host PRIVATE hairloom::runtime m)
TEXT

# library NAME CC CXX FLAGS…: static and shared, each by CMake from a project in C alone and by pkg-config.
library() {
    local name=$1 cc=$2 cxx=$3 kind prefix
    shift 3
    for kind in OFF ON; do
        local label="$name, library$([ $kind = ON ] && echo ', shared')" dir=$build/${name// /-}-$kind
        prefix=$dir/prefix
        if ! quiet "${name// /-}-$kind" cmake -S "$top/runtime" -B "$dir" -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=$kind \
            "-DCMAKE_CXX_COMPILER=$cxx" "-DCMAKE_CXX_FLAGS=$* -march=haswell -DHWY_COMPILE_ONLY_STATIC" -DCMAKE_INSTALL_LIBDIR=lib ||
            ! quiet "${name// /-}-$kind" cmake --build "$dir" -j "$(nproc)" ||
            ! quiet "${name// /-}-$kind" cmake --install "$dir" --prefix "$prefix"; then
            fail "$label" "does not build"
            continue
        fi
        if [ $kind = ON ]; then
            local more
            more=$(nm -D --defined-only "$prefix/lib/libhairloom_runtime.so" | awk '$3 !~ /^hl_/ && $2 ~ /[TDBW]/ { print $3 }' | head -3)
            [ -z "$more" ] || fail "$label" "exports $more"
        fi
        quiet host cmake -S "$build" -B "$dir/host" "-DCMAKE_C_COMPILER=$cc" "-DCMAKE_PREFIX_PATH=$prefix" &&
            quiet host cmake --build "$dir/host" &&
            judge "$label, CMake in C" "$("$dir/host/host" "$asset" 2>> "$build/host.log")" ||
            fail "$label, CMake in C" "does not build"
        # The flags stand in a variable of pkg-config's, so they are split.
        # shellcheck disable=SC2046
        quiet host "$cc" -std=c99 -O2 "$host" $(PKG_CONFIG_PATH=$prefix/lib/pkgconfig pkg-config --cflags --libs hairloom-runtime) \
            -Wl,-rpath,"$prefix/lib" -lm -o "$dir/by_pkg_config" &&
            judge "$label, pkg-config" "$("$dir/by_pkg_config" "$asset" 2>> "$build/host.log")" ||
            fail "$label, pkg-config" "does not build"
    done
}

# single NAME CC CXX RUN FLAGS…: RUN starts programs that are not of this system, or is empty.
single() {
    local name=$1 cc=$2 cxx=$3 run=$4 flags=${*:5} dir=$build/single
    local object="$dir/${name//[ ,]/-}${flags//[ =+]/-}"
    # shellcheck disable=SC2086
    quiet single "$cxx" -std=c++20 $flags "-I$dir" -c "$dir/hair.cpp" -o "$object.o" &&
        quiet single "$cc" -std=c99 -O2 -DSINGLE_HEADER "-I$dir" -c "$host" -o "$object-host.o" &&
        quiet single "$cxx" $flags "$object-host.o" "$object.o" ${link:-} -lm -o "$object.${suffix:-bin}" ||
        { fail "$name, header $flags" "does not build"; return; }
    judge "$name, header $flags" "$($run "$object.${suffix:-bin}" "$asset" 2>> "$build/single.log" | tr -d '\r')"
}

wanted() { [ ${#names[@]} -eq 0 ] || printf '%s\n' "${names[@]}" | grep -qxF "$1"; }
names=("$@")

mkdir -p "$build/single"
quiet single-header cmake -S "$top/runtime" -B "$build/header" && quiet single-header cmake --build "$build/header" --target hairloom_single ||
    { say "the single header is not made"; exit 1; }
cp "$build/header/hairloom_single.h" "$build/single/"
printf '#define HAIRLOOM_IMPLEMENTATION\n#include "hairloom_single.h"\n' > "$build/single/hair.cpp"

for version in gcc-12 clang-14 clang-16 clang-19; do
    cc=$version cxx=${version/gcc/g++}
    cxx=${cxx/clang/clang++}
    wanted "$version" || continue
    command -v "$cxx" > /dev/null || { row "$version" "skipped: there is no $cxx"; continue; }
    library "$version" "$cc" "$cxx"
    single "$version" "$cc" "$cxx" "" -O2 -march=haswell -ffp-contract=off
    if [ "$version" = gcc-12 ] || [ "$version" = clang-16 ]; then
        for flags in "-O1 -march=haswell" "-O3 -march=native" "-O2 -march=haswell -ffp-contract=fast" "-Os -march=haswell -g" \
            "-O3 -march=haswell -fno-math-errno -funroll-loops" "-O2 -msse4.2" "-O2 -DHAIRLOOM_NO_WARNING"; do
            # shellcheck disable=SC2086
            single "$version" "$cc" "$cxx" "" $flags
        done
    fi
    [[ "$version" != clang-* ]] ||
        if "$cxx" -stdlib=libc++ -std=c++20 -fsyntax-only -include span -x c++ /dev/null 2> /dev/null; then
            link=-stdlib=libc++ single "$version libc++" "$cc" "$cxx" "" -stdlib=libc++ -O2 -march=haswell
        else
            row "$version libc++" "skipped: it finds no libc++ of its own (libc++-${version#clang-}-dev, one at a time)"
        fi
done

if wanted mingw; then
    if command -v x86_64-w64-mingw32-g++-posix > /dev/null; then
        wine=$(command -v wine64 || command -v wine || true)
        if [ -n "$wine" ]; then
            mkdir -p "$build/single/hwy-only" && ln -sfn /usr/include/hwy "$build/single/hwy-only/hwy"
            suffix=exe link=-static single mingw x86_64-w64-mingw32-gcc-posix x86_64-w64-mingw32-g++-posix "$wine" -O2 -march=haswell \
                "-I$build/single/hwy-only"
        else
            row mingw "skipped: there is no wine to run what it builds"
        fi
    else
        row mingw "skipped: there is no x86_64-w64-mingw32-g++-posix"
    fi
fi
if wanted emscripten; then
    if command -v em++ > /dev/null && command -v node > /dev/null; then
        mkdir -p "$build/single/hwy-only" && ln -sfn /usr/include/hwy "$build/single/hwy-only/hwy"
        # Debian's finds Debian's packages for node with another node, too.
        NODE_PATH=/usr/share/nodejs suffix=js link="-sNODERAWFS=1 -sALLOW_MEMORY_GROWTH=1" \
            single emscripten emcc em++ node -O2 -msimd128 "-I$build/single/hwy-only"
    else
        row emscripten "skipped: there is no em++ or no node"
    fi
fi

printf '\n%s\n' "Compilers of the runtime:"
printf '  %s\n' "${table[@]}"
exit $failed
