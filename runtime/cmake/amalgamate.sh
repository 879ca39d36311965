#!/bin/sh
# SPDX-License-Identifier: MIT
# amalgamate.sh RUNTIME SOURCE… > hairloom_single.h: the C interface and, behind HAIRLOOM_IMPLEMENTATION, the sources that are
# named (from the folder RUNTIME) with all headers of ours, each once.
set -eu
runtime=$1
shift
cat "$runtime/LICENSE" | sed -e '1i /*' -e 's/^/ * /' -e '$a */' | sed -e 's/^ \* \/\*$/\/*/' -e 's/^ \* \*\/$/ *\//' -e 's/ *$//'
cat <<'TEXT'
/* Hairloom's runtime in one file. Its interface is C99. In one file of C++20 say
 *     #define HAIRLOOM_IMPLEMENTATION
 *     #include "hairloom_single.h"
 * and compile it for the instruction set of the machines that you ship to: it has that one alone.
 *     -O2 -ffp-contract=off -march=haswell    Intel since 2013, AMD since 2015: 8 floats at a time, with fused multiply-add
 *     -O2 -ffp-contract=off -msse4.2          machines of 2009: 4 floats
 *     -O2 -ffp-contract=off                   ARM of 64 bits: 4 floats
 * Without one of the first two, x86 gets code without vectors, eight times slower: a #warning says so
 * (HAIRLOOM_NO_WARNING silences it), and hl_build_info() tells what there is. The library of several files takes
 * the best of the machine by itself. Highway's headers have to be found (Debian: libhwy-dev). */
TEXT
awk -v runtime="$runtime" '
    function dirname(path) { sub(/\/[^\/]*$/, "", path); return path }
    function exists(path,   line, got) { got = (getline line < path); close(path); return got >= 0 }
    function resolve(from, name,   path) {
        path = dirname(from) "/" name
        if (exists(path)) return path
        path = runtime "/include/" name
        if (exists(path)) return path
        path = runtime "/" name
        return exists(path) ? path : ""
    }
    function emit(path,   line, name, other) {
        if (path in seen) return
        seen[path] = 1
        while ((getline line < path) > 0) {
            if (line ~ /^\/\/ SPDX/ || line ~ /^#pragma once/) continue
            if (line ~ /^#include "/) {
                name = line
                sub(/^#include "/, "", name)
                sub(/".*/, "", name)
                other = resolve(path, name)
                if (other != "") { emit(other); continue }
            }
            print line
        }
        close(path)
    }
    BEGIN {
        emit(runtime "/include/hairloom/hairloom.h")
        emit(runtime "/include/hairloom/gpu.h")
        print "#if defined(HAIRLOOM_IMPLEMENTATION) && !defined(HAIRLOOM_IMPLEMENTED)"
        print "#define HAIRLOOM_IMPLEMENTED"
        print "#if defined(__FAST_MATH__)"
        print "#error \"Hairloom tells numbers from what is none, and gives the same bits: compile it without -ffast-math\""
        print "#endif"
        print "/* Flags name no AES, which Highway wants beside AVX2 and nothing here uses. */"
        print "#if !defined(HWY_DISABLE_PCLMUL_AES)"
        print "#define HWY_DISABLE_PCLMUL_AES"
        print "#endif"
        print "/* The same arithmetic whatever the flags of the file, as far as pragmas go. */"
        print "#if defined(__clang__)"
        print "#pragma float_control(push)"
        print "#pragma clang fp contract(off)"
        print "#elif defined(__GNUC__)"
        print "#pragma GCC push_options"
        print "#pragma GCC optimize(\"fp-contract=off\", \"no-tree-slp-vectorize\")"
        print "#endif"
        print "#ifndef HWY_COMPILE_ONLY_STATIC"
        print "#define HWY_COMPILE_ONLY_STATIC"
        print "#endif"
        for (i = 1; i < ARGC; ++i) emit(runtime "/" ARGV[i])
        print "#if !defined(HAIRLOOM_NO_WARNING) && (HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128)"
        print "#warning \"Hairloom is compiled without vectors and runs 8 times slower: add -march=haswell, or -msse4.2\""
        print "#endif"
        print "#if defined(__clang__)"
        print "#pragma float_control(pop)"
        print "#elif defined(__GNUC__)"
        print "#pragma GCC pop_options"
        print "#endif"
        print "#endif"
    }' "$@"
