#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# verify_wheel.sh WHEEL ROOTS: installs the wheel with pip in a bare Debian (12 for CPython 3.11, 13 for abi3) with nothing but Python and NumPy,
# imports it and makes hair there. Roots are made in ROOTS where they are missing. Needs root.
set -euo pipefail
wheel=$(readlink -f "${1:?the wheel}")
mkdir -p "${2:?a folder for the roots}"
roots=$(cd "$2" && pwd)
case "$(basename "$wheel")" in
    *-cp311-cp311-*) release=bookworm ;;
    *-abi3-*) release=trixie ;;
    *) echo "error: $wheel is for none of the Pythons of Debian 12 and 13" >&2; exit 1 ;;
esac

root=$roots/python-$release
if [ ! -x "$root/usr/bin/python3" ]; then
    # Archives come from where this machine has its own; a debootstrap that is older than the release takes the last one's ways.
    mirror=$(apt-get indextargets --format '$(SITE)' 'Codename: bookworm' 'Created-By: Packages' | sed -n 1p)
    script=/usr/share/debootstrap/scripts/$release
    [ -e "$script" ] || script=/usr/share/debootstrap/scripts/sid
    debootstrap --variant=minbase --include=python3,python3-venv "$release" "$root" "$mirror" "$script" >&2
fi
rm -rf "$root/try" && mkdir -p "$root/try/wheels"
cp "$wheel" "$root/try/wheels/"
# NumPy of the root's Python: the root itself has no network.
version=$(chroot "$root" python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])')
python3 -m pip download --quiet --no-deps --only-binary :all: --python-version "$version" --dest "$root/try/wheels" \
    "$(grep '^numpy==' "$(dirname "$(readlink -f "$0")")/../python/requirements.txt")"
mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
trap 'umount "$root/proc"' EXIT
inside() { chroot "$root" /usr/bin/env -i PATH=/usr/bin:/bin HOME=/root LC_ALL=C.UTF-8 "$@"; }
inside python3 -m venv /try/venv
inside /try/venv/bin/pip install --quiet --no-index --find-links /try/wheels hairloom
inside /try/venv/bin/python -c "import hairloom"
inside sh -c 'cd /try && cat > make.py && /try/venv/bin/python make.py' <<'PYTHON'
import os
import hairloom

bust = os.path.join(os.path.dirname(hairloom.__file__), "share/hairloom/samples/bust/bust.glb")
report = hairloom.create(mesh=bust, scalp="material:scalp", count=100, length=0.1, points=8, output="hair.hairloom")
groom = hairloom.Groom.open("hair.hairloom")
assert len(groom) == report.strands == 100, (len(groom), report)
frames = list(groom.simulate("nod", frames=3))
assert len(frames) == 3
hairloom.export("hair.hairloom", format="abc", output="hair.abc")
PYTHON
echo "ok   $release: pip installs $(basename "$wheel"), which makes, simulates and exports hair with Python $version and NumPy alone"
