#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: packaging/windows/clang.sh BUILD
# Shows the sources that are for Windows only, or have parts that are, to a second compiler: clang, with the headers of
# mingw-w64 and the flags that the build folder BUILD compiles them with. Fails on any warning.
set -euo pipefail
cd "$1"
headers=$(dirname "$(x86_64-w64-mingw32-g++-posix -print-libgcc-file-name)")/include/c++
clang="clang++-14 --target=x86_64-w64-mingw32 -isystem $headers -isystem $headers/x86_64-w64-mingw32 -fsyntax-only"
only='d3d11/[a-z_0-9]+|_windows|_win32|/hlsl_to_dxbc|/hlslc'
partly='base\.dir/file|accuracy\.dir/thread_clock|gpu\.dir/device|vulkan/(instance|swap_chain)|/hlsl_compiler|mesh-reader\.dir/main'
failures=0
count=0
while read -r object; do
    count=$((count + 1))
    command=$(ninja -t commands "$object" | tail -1 |
              sed -E "s|^.*x86_64-w64-mingw32-g\+\+-posix |$clang |; s/ -Wa,-mbig-obj//; s/ -fpch-preprocess//; s/ -Wno-(array-bounds|restrict|stringop-overflow|stringop-overread)//g; s/ -Winvalid-pch -include [^ ]*cmake_pch[.]hxx//; s/ -MD .* -c / /")
    eval "$command" || { failures=$((failures + 1)); echo "failed: $object" >&2; }
done < <(ninja -t targets all | sed 's/:.*//' | grep -E "($only|$partly)\.cpp\.obj$")
echo "$count sources, $failures failed"
[ "$count" -gt 0 ] && [ "$failures" -eq 0 ]
