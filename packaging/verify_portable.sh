#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# verify_portable.sh ARCHIVE ROOTS: unpacks the portable archive in a bare Debian 12 and a bare Debian 13, which are made in ROOTS
# where they are missing, and runs the command line and the editor there. Needs root.
set -euo pipefail
archive=$(readlink -f "${1:?the archive}")
mkdir -p "${2:?a folder for the roots}"
roots=$(cd "$2" && pwd)

for release in bookworm trixie; do
    root=$roots/bare-$release
    if [ ! -x "$root/usr/bin/dpkg" ]; then
        # Archives come from where this machine has its own; a debootstrap that is older than the release takes the last one's ways.
        mirror=$(apt-get indextargets --format '$(SITE)' 'Codename: bookworm' 'Created-By: Packages' | sed -n 1p)
        script=/usr/share/debootstrap/scripts/$release
        [ -e "$script" ] || script=/usr/share/debootstrap/scripts/sid
        debootstrap --variant=minbase "$release" "$root" "$mirror" "$script" >&2
    fi
    mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
    trap 'umount "$root/proc"' EXIT
    rm -rf "$root/try" && mkdir -p "$root/try"
    tar -C "$root/try" --strip-components=1 -xzf "$archive"
    inside() { chroot "$root" /usr/bin/env -i PATH=/usr/bin:/bin HOME=/root LC_ALL=C.UTF-8 QT_QPA_PLATFORM=offscreen "$@"; }
    inside /try/bin/hairloom-cli create --mesh /try/share/hairloom/samples/bust/bust.glb --scalp material:scalp --count 200 \
        --length 0.2 -o /try/hair.hairloom >/dev/null
    inside /try/bin/hairloom-cli simulate /try/hair.hairloom --frames 30 --motion nod >/dev/null
    inside /try/bin/hairloom-cli export /try/hair.hairloom --format runtime -o /try/hair.hairrt >/dev/null
    echo "ok   $release: the command line makes, simulates and exports hair"
    inside /try/bin/hairloom --quit-when-shown /try/hair.hairloom
    echo "ok   $release: the editor opens it"
    umount "$root/proc"
    trap - EXIT
done
