#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# portable.sh BUILD OUT: the application with every library that it needs but the C library and drivers, as
# OUT/hairloom-VERSION-x86_64.tar.gz. It runs from wherever it is unpacked, on Debian 12 and later.
set -euo pipefail
build=$(cd "${1:?a build folder}" && pwd)
mkdir -p "${2:?a folder for the archive}"
out=$(cd "$2" && pwd)
version=$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$build/CMakeCache.txt")
name=hairloom-$version-$(uname -m)
top=$out/$name
rm -rf "$top"

cmake --install "$build" --component application --prefix "$top" --strip >/dev/null
# The libraries of videos would double the archive.
rm -f "$top/bin/hairloom-video-writer"

plugins=$(qtpaths6 --query QT_INSTALL_PLUGINS)
for plugin in platforms/libqxcb.so platforms/libqoffscreen.so imageformats/libqsvg.so imageformats/libqjpeg.so \
    iconengines/libqsvgicon.so platforminputcontexts/libcomposeplatforminputcontextplugin.so xcbglintegrations/libqxcb-glx-integration.so; do
    [ -f "$plugins/$plugin" ] || { echo "error: $plugins/$plugin is missing" >&2; exit 1; }
    install -D "$plugins/$plugin" "$top/plugins/$plugin"
done

# The C library has to be that of the machine, since drivers are loaded beside it.
mkdir -p "$top/lib"
needed() { ldd "$@" 2>/dev/null | awk '$2 == "=>" && $3 ~ /^\// { print $3 }' | sort -u; }
needed "$top"/bin/* "$top"/plugins/*/*.so |
    grep -vE '/(ld-linux.*|libc|libm|libdl|libpthread|librt|libresolv|libutil|libanl|libnsl|libnss_.*|libvulkan)\.so' |
    while read -r library; do cp -L "$library" "$top/lib/"; done
patchelf --set-rpath '$ORIGIN/../lib' "$top"/bin/*
patchelf --set-rpath '$ORIGIN/../../lib' "$top"/plugins/*/*.so
# Those found by another library are looked for beside it.
patchelf --set-rpath '$ORIGIN' "$top"/lib/*.so*
printf '[Paths]\nPrefix = ..\nPlugins = plugins\n' > "$top/bin/qt.conf"

# What each library is, and where its licence stands.
{
    echo "Libraries in lib/ and plugins/, from these packages of Debian; each licence is in licences/."
    mkdir -p "$top/licences"
    for library in $(needed "$top"/bin/* "$plugins"/platforms/libqxcb.so "$plugins"/iconengines/libqsvgicon.so) ; do
        dpkg-query -S "$(readlink -f "$library")" 2>/dev/null | cut -d : -f 1 || true
    done | sort -u | while read -r package; do
        [ -f "/usr/share/doc/$package/copyright" ] || continue
        cp -L "/usr/share/doc/$package/copyright" "$top/licences/$package"
        dpkg-query -W -f='${Package} ${Version}\n' "$package" 2>/dev/null | head -1
    done
} > "$top/libraries.txt"

cat > "$top/README.txt" <<TEXT
Hairloom $version for Linux on x86-64 (glibc 2.36 or later: Debian 12, Ubuntu 23.04 and younger).

    bin/hairloom          the editor; pictures need a Vulkan driver (mesa-vulkan-drivers, or your GPU's)
    bin/hairloom-cli      every job without a window; bin/hairloom-cli --help

Nothing needs to be installed. Remove the folder to remove it all.
TEXT
tar -C "$out" --sort=name --owner=0 --group=0 --numeric-owner -czf "$out/$name.tar.gz" "$name"
rm -rf "$top"
ls -l "$out/$name.tar.gz"
