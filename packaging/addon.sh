#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# addon.sh DIST WORK [--zip]: makes the extension of blender/ for Blender with the wheel of Python 3.12 and later, which lies in DIST or is
# built there, installs it in Blender's own module bpy (PyPI) of each version that it is for, and runs blender/tests there. With --zip
# it only makes DIST/hairloom-blender-VERSION.zip. Where there is no Python 3.13 with headers (HAIRLOOM_PYTHON313 names one), it is
# Debian 13's, in a bare root below WORK, which needs root.
set -euo pipefail
top=$(cd "$(dirname "$(readlink -f "$0")")/.." && pwd)
mkdir -p "${1:?a folder for the extension}" "${2:?a folder to work in}"
dist=$(cd "$1" && pwd)
work=$(cd "$2" && pwd)
only=${3:-}
cd "$top"
versions=(5.2.3 5.3.0)

hasHeaders() { "$1" -c 'import os, sys, sysconfig; raise SystemExit(sys.version_info[:2] != (3, 13) or not os.path.exists(sysconfig.get_paths()["include"] + "/Python.h"))' 2>/dev/null; }
python=
for one in ${HAIRLOOM_PYTHON313:-} python3.13; do
    if hasHeaders "$one"; then python=$(command -v "$one"); break; fi
done

if [ -z "$python" ]; then
    [ "$(id -u)" -eq 0 ] || { echo "error: there is no Python 3.13 with headers, and a bare Debian 13 needs root" >&2; exit 1; }
    root=$work/bare-trixie
    if [ ! -x "$root/usr/bin/dpkg" ]; then
        # Archives come from where this machine has its own; a debootstrap that is older than the release takes the last one's ways.
        mirror=$(apt-get indextargets --format '$(SITE)' 'Codename: bookworm' 'Created-By: Packages' | sed -n 1p)
        script=/usr/share/debootstrap/scripts/trixie
        [ -e "$script" ] || script=/usr/share/debootstrap/scripts/sid
        debootstrap --variant=minbase trixie "$root" "$mirror" "$script" >&2
    fi
    cp /etc/resolv.conf "$root/etc/" 2>/dev/null || true
    if [ ! -x "$root/usr/bin/python3.13" ] || [ ! -e "$root/usr/include/python3.13/Python.h" ]; then
        chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive sh -c '
            apt-get update -qq && apt-get -o Dpkg::Use-Pty=0 install -y -qq --no-install-recommends python3 python3-dev python3-venv \
                libx11-6 libxi6 libxxf86vm1 libxfixes3 libxrender1 libxkbcommon0 libsm6 libice6 libgl1 libegl1 libgomp1' >&2
    fi
    # What venv installs pip from, which this system has another of.
    sed -i "s#sysconfig.get_config_var('WHEEL_PKG_DIR')#'$root/usr/share/python-wheels'#" "$root/usr/lib/python3.13/ensurepip/__init__.py"
    # Debian's pyconfig.h includes that of its architecture by a path below /usr/include, which is another system's here.
    mkdir -p "$root/usr/include/python3.13/x86_64-linux-gnu"
    ln -sfn ../../x86_64-linux-gnu/python3.13 "$root/usr/include/python3.13/x86_64-linux-gnu/python3.13"
    # Its own loader and libraries run it here, beside the compilers and libraries that the wheel is built with.
    mkdir -p "$work/python/bin"
    ln -sfn "$root/usr/lib" "$work/python/lib"
    ln -sfn "$root/usr/include" "$work/python/include"
    python=$work/python/bin/python3.13
    cat > "$python" <<TEXT
#!/bin/sh
libraries=$root/usr/lib/x86_64-linux-gnu
exec \$libraries/ld-linux-x86-64.so.2 --library-path \$libraries --argv0 "\$0" $root/usr/bin/python3.13 "\$@"
TEXT
    chmod +x "$python"
    hasHeaders "$python" || { echo "error: the Python of Debian 13 in $root does not run here" >&2; exit 1; }
fi

version=$(sed -n 's/^project(Hairloom VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
wheel=$(ls "$dist/hairloom-$version"-cp312-abi3-*.whl 2>/dev/null | head -1 || true)
newer=
[ -z "$wheel" ] || newer=$(find python core exporters importers runtime cli shaders samples CMakeLists.txt -name '*.*' -newer "$wheel" -type f -print -quit)
if [ -z "$wheel" ] || [ -n "$newer" ]; then
    packaging/wheel.sh "$dist" "$python"
    wheel=$(ls "$dist/hairloom-$version"-cp312-abi3-*.whl | head -1)
fi

# The extension as Blender's own builder makes it, which checks the manifest.
for blender in "${versions[@]}"; do
    venv=$work/blender-$blender
    [ -d "$venv" ] || "$python" -m venv "$venv"
    "$venv/bin/pip" install --quiet "bpy==$blender"
done
newest=${versions[${#versions[@]} - 1]}
builder=$(ls "$work/blender-$newest"/lib/python3.13/site-packages/bpy/*/scripts/addons_core/bl_pkg/cli/blender_ext.py)
rm -rf "$work/extension"
mkdir -p "$work/extension/wheels"
cp blender/*.py blender/blender_manifest.toml "$work/extension/"
cp LICENSES/GPL-3.0-or-later.txt "$work/extension/LICENSE" 2>/dev/null || cp COPYING "$work/extension/LICENSE"
cp "$wheel" "$work/extension/wheels/"
python3 - "$work/extension/blender_manifest.toml" "./wheels/$(basename "$wheel")" <<'TEXT'
import sys
path, wheel = sys.argv[1:]
text = open(path).read()
open(path, "w").write(text.replace("\n[permissions]", f'\nwheels = ["{wheel}"]\n\n[permissions]', 1))
TEXT
zip=$dist/hairloom-blender-$version.zip
rm -f "$zip"
"$work/blender-$newest/bin/python" "$builder" build --source-dir "$work/extension" --output-filepath "$zip" >&2
ls -l "$zip"
[ "$only" != --zip ] || exit 0

for blender in "${versions[@]}"; do
    run=("$work/blender-$blender/bin/python")
    # A home of its own: nothing of this machine's Blender is read or changed.
    home=$work/home-$blender
    rm -rf "$home"
    mkdir -p "$home"
    export BLENDER_USER_RESOURCES=$home PYTHONDONTWRITEBYTECODE=1
    echo "Blender $blender"
    "${run[@]}" blender/tests/install.py "$zip"
    (cd blender/tests && "${run[@]}" -m unittest)
done
echo "ok   the extension installs, and all its tests pass in Blender ${versions[*]}"
