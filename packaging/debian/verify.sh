#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# verify.sh PACKAGES ROOT: installs the two packages of the folder PACKAGES in a bare Debian 12, which is made in ROOT where it is
# missing, and holds there what README.md and docs/integrate.md say of them. Needs root.
set -euo pipefail
top=$(cd "$(dirname "$(readlink -f "$0")")/../.." && pwd)
packages=$(cd "${1:?the folder of the packages}" && pwd)
mkdir -p "${2:?a folder for the root}"
root=$(cd "$2" && pwd)

# Archives come from where this machine has its own.
if [ ! -x "$root/usr/bin/apt-get" ]; then
    mirror=$(apt-get indextargets --format '$(SITE)' 'Codename: bookworm' 'Created-By: Packages' | sed -n 1p)
    debootstrap --variant=minbase bookworm "$root" "$mirror" >&2
fi
# A program asks /proc where it lies.
mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
trap 'umount "$root/proc"' EXIT
cp /etc/resolv.conf "$root/etc/" 2>/dev/null || true
inside() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 QT_QPA_PLATFORM=offscreen "$@"; }

rm -rf "$root/try"
mkdir -p "$root/try"
cp "$packages"/*.deb "$root/try/"
cp -r "$top/samples/player" "$root/try/player"
awk '/^```c$/ { inside = 1; next } inside && /^```$/ { exit } inside' "$top/docs/integrate.md" > "$root/try/game.c"
inside apt-get update -qq
inside sh -c 'apt-get -o Dpkg::Use-Pty=0 install -y -qq --no-install-recommends /try/hairloom_*.deb' >&2
echo "ok   the application installs"

inside hairloom-cli create --mesh /usr/share/hairloom/samples/bust/bust.glb --scalp material:scalp --count 200 --length 0.2 \
    -o /try/hair.hairloom > /dev/null
inside hairloom-cli simulate /try/hair.hairloom --frames 30 --motion nod > /dev/null
inside hairloom-cli export /try/hair.hairloom --format runtime -o /try/hair.hairrt > /dev/null
inside hairloom-cli takes /try/hair.hairloom --record nod --motion nod --frames 4 > /dev/null
inside hairloom-cli takes /try/hair.hairloom --export nod --format mp4 --size 64x64 -o /try/nod.mp4 > /dev/null
[ -s "$root/try/nod.mp4" ]
echo "ok   a take is written as video"
if [ -e "$root/usr/share/hairloom/web/player.js" ]; then
    inside hairloom-cli export /try/hair.hairloom --format web -o /try/page > /dev/null
    [ -s "$root/try/page/index.html" ]
    echo "ok   a page for browsers is written"
fi
inside hairloom --quit-when-shown /try/hair.hairloom
echo "ok   hairloom-cli and hairloom run"
for file in bin/hairloom-mesh-reader bin/hairloom-mesh-writer bin/hairloom-video-writer share/applications/hairloom.desktop share/mime/packages/hairloom.xml \
    share/icons/hicolor/scalable/apps/hairloom.svg share/man/man1/hairloom.1 share/man/man1/hairloom-cli.1 share/doc/hairloom/copyright; do
    [ -e "$root/usr/$file" ] || [ -e "$root/usr/$file.gz" ] || { echo "FAIL /usr/$file is missing"; exit 1; }
done
echo "ok   desktop file, type, icon and manual pages are there"

inside sh -c 'apt-get -o Dpkg::Use-Pty=0 install -y -qq --no-install-recommends /try/hairloom-runtime-dev_*.deb cmake g++ make' >&2
inside sh -c 'cmake -S /try/player -B /try/build > /dev/null && cmake --build /try/build > /dev/null && /try/build/player /try/hair.hairrt --frames 30'
echo "ok   samples/player builds by find_package(hairloom-runtime) and plays"
inside sh -c 'cc -std=c99 -O2 -c /try/game.c -o /try/game.o $(pkg-config --cflags hairloom-runtime) &&
    cc /try/game.o $(pkg-config --libs hairloom-runtime) -o /try/game && /try/game /try/hair.hairrt'
echo "ok   the C99 program of docs/integrate.md builds by pkg-config and plays"
inside apt-get -o Dpkg::Use-Pty=0 remove -y -qq hairloom hairloom-runtime-dev >&2
[ ! -e "$root/usr/bin/hairloom" ] && [ ! -e "$root/usr/include/hairloom" ]
echo "ok   both leave nothing behind"
