#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: packaging/windows/d3dcompiler.sh FOLDER
# Puts Microsoft's d3dcompiler_47.dll into FOLDER: it comes with the npm package webgpu, of which exactly this version is
# taken. The compiler is used to build, and is not part of what is built.
set -euo pipefail
package=webgpu@0.6.2
archive_sha256=77a6be6513b9f7c2e94425620ce603efb38cdc5d0393e1b31a1b0c8479330ffd
library_sha256=289767b49dc8525bce262ea06fee4ef9fced2e131a55b25654ce871c1f0498b2

mkdir -p "$1"
cd "$1"
holds() { [ -f "$1" ] && printf '%s  %s\n' "$2" "$1" | sha256sum --check --status; }
holds d3dcompiler_47.dll "$library_sha256" && exit
command -v npm > /dev/null || { echo "error: npm is needed once to fetch $package" >&2; exit 1; }
npm pack --silent "$package" > /dev/null
holds webgpu-0.6.2.tgz "$archive_sha256" || { echo "error: $package is not the package that is known" >&2; exit 1; }
tar -xzf webgpu-0.6.2.tgz --strip-components=3 package/dist/win32-x64/d3dcompiler_47.dll
rm webgpu-0.6.2.tgz
holds d3dcompiler_47.dll "$library_sha256" || { echo "error: $package has another d3dcompiler_47.dll" >&2; exit 1; }
