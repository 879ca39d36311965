#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# build.sh BUILD OUT: compiles the runtime with Emscripten and bundles it with the page's scripts and three.js into OUT/player.js,
# beside which index.html goes. Packages of npm are in BUILD/node_modules.
set -euo pipefail
here=$(cd "$(dirname "$(readlink -f "$0")")" && pwd)
mkdir -p "${1:?a folder to build in}" "${2:?a folder for the player}"
build=$(cd "$1" && pwd) out=$(cd "$2" && pwd)
# Debian's Emscripten finds Debian's packages for node with another node, too.
export NODE_PATH=/usr/share/nodejs
[ -f "$build/build.ninja" ] || emcmake cmake -S "$here" -B "$build" -G Ninja >&2
cmake --build "$build" -j "$(nproc)" >&2
cmp -s "$here/package.json" "$build/package.json" && [ -d "$build/node_modules" ] || {
    cp "$here/package.json" "$build/package.json"
    npm install --silent --no-fund --no-audit --no-package-lock --prefix "$build" >&2
}
NODE_PATH="$build/node_modules" "$build/node_modules/.bin/esbuild" "$here/page/main.js" --bundle --minify --format=iife --target=es2022 \
    --alias:hairloom-engine="$build/engine.js" --log-level=warning --legal-comments=inline --outfile="$out/player.js"
cp "$here/page/index.html" "$out/index.html"
