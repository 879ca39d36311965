#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: packaging/windows/clang.sh BUILD
# Shows the sources that are for Windows only, or have parts that are, to a second compiler: clang, with the headers of
# mingw-w64 and the flags that the build folder BUILD compiles them with. Fails on any warning.
set -euo pipefail
cd "$1"
headers=$(dirname "$(x86_64-w64-mingw32-g++-posix -print-libgcc-file-name)")/include/c++
clang="clang++-14 --target=x86_64-w64-mingw32 -isystem $headers -isystem $headers/x86_64-w64-mingw32 -fsyntax-only"
top=$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' CMakeCache.txt)
# ofWindows SOURCE: what cmake/HairloomUnity.cmake leaves an object of its own for it. Of the tests only what opens windows.
ofWindows() {
    case $1 in
        */d3d11/* | *_windows.cpp | *_win32.cpp) [ -f "$top/$1" ] ;;
        tests/*) false ;;
        *) [ -f "$top/$1" ] && grep -qE '_WIN32|<windows[.]h>' "$top/$1" ;;
    esac
}
failures=0
count=0
while read -r object; do
    ofWindows "$(sed -E 's|CMakeFiles/[^/]+\.dir/||; s|^[^_]*/__/||; s|\.obj$||' <<< "$object")" || continue
    count=$((count + 1))
    command=$(ninja -t commands "$object" | tail -1 |
              sed -E "s|^.*x86_64-w64-mingw32-g\+\+-posix |$clang |; s/ -Wa,-mbig-obj//; s/ -fpch-preprocess//; s/ -Wno-(array-bounds|restrict|stringop-overflow|stringop-overread|subobject-linkage)//g; s/ -Winvalid-pch -include [^ ]*cmake_pch[.]hxx//; s/ -MD .* -c / /")
    eval "$command" || { failures=$((failures + 1)); echo "failed: $object" >&2; }
done < <(ninja -t targets all | sed 's/:.*//' | grep -E "\.cpp\.obj$" | grep -v '/Unity/')
echo "$count sources, $failures failed"
[ "$count" -gt 0 ] && [ "$failures" -eq 0 ]
