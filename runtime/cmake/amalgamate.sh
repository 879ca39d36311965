#!/bin/sh
# SPDX-License-Identifier: MIT
# amalgamate.sh RUNTIME SOURCE… > hairloom_single.h: the C interface and, behind HAIRLOOM_IMPLEMENTATION, the sources that are
# named (from the folder RUNTIME) with all headers of ours, each once.
set -eu
runtime=$1
shift
cat "$runtime/LICENSE" | sed -e '1i /*' -e 's/^/ * /' -e '$a */' | sed -e 's/^ \* \/\*$/\/*/' -e 's/^ \* \*\/$/ *\//' -e 's/ *$//'
cat <<'TEXT'
/* Hairloom's runtime in one file. Its interface is C99. In one file of C++20 that is compiled with -ffp-contract=off say
 *     #define HAIRLOOM_IMPLEMENTATION
 *     #include "hairloom_single.h"
 * Highway's headers have to be found (Debian: libhwy-dev). It is compiled for one instruction set, that of the compiler's flags:
 * -march=haswell, say; the library of several files has more and takes the best that it finds. */
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
        print "#if defined(HAIRLOOM_IMPLEMENTATION) && !defined(HAIRLOOM_IMPLEMENTED)"
        print "#define HAIRLOOM_IMPLEMENTED"
        print "#ifndef HWY_COMPILE_ONLY_STATIC"
        print "#define HWY_COMPILE_ONLY_STATIC"
        print "#endif"
        for (i = 1; i < ARGC; ++i) emit(runtime "/" ARGV[i])
        print "#endif"
    }' "$@"
