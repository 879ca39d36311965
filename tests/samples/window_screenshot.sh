#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: xvfb-run -a -s "-screen 0 640x640x24 -noreset" tests/samples/window_screenshot.sh PICTURE.png PROGRAM [ARGUMENT…]
# Runs hairloom-window on a display of its own and photographs the screen after ten pictures and after twenty. The first
# photograph stays as PICTURE.png.
# Fails unless the program ends well, the screen shows a shaded picture, and that picture moves.
set -euo pipefail
picture=$1
shift
mkdir -p "$(dirname "$picture")"
later=$(mktemp --suffix=.png)
trap 'rm -f "$later"' EXIT

shown=0
last=
while read -r line; do
    last=$line
    printf '%s\n' "$line"
    case "$line" in *' images, '*) ;; *) continue ;; esac
    shown=$((shown + 1))
    # What is presented is on the screen a little later.
    sleep 0.3
    if [ "$shown" -eq 1 ]; then import -window root "$picture"; fi
    if [ "$shown" -eq 2 ]; then import -window root "$later"; fi
done < <("$@" --pictures 20 --hold 4 && echo 'ended with 0' || echo "ended with $?")
case "$last" in
    'ended with 0') ;;
    # Wine's server kills a program that is not gone a second after its end: too short for drivers on a busy machine.
    'ended with 137') echo 'killed while it closed down' ;;
    *) echo "error: the program failed" >&2; exit 1 ;;
esac
[ "$shown" -ge 2 ] || { echo "error: the program showed nothing" >&2; exit 1; }

colours=$(identify -format %k "$picture")
[ "$colours" -gt 1000 ] || { echo "error: $colours colours on the screen; expected a shaded picture" >&2; exit 1; }
# Pixels that differ by more than 5 %.
moved=$(compare -metric AE -fuzz 5% "$picture" "$later" null: 2>&1 || true)
echo "$colours colours, $moved pixels moved"
[ "${moved%.*}" -gt 2000 ] || { echo "error: nothing moves on the screen" >&2; exit 1; }
