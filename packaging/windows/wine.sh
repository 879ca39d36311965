#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: packaging/windows/wine.sh PROGRAM.exe [ARGUMENT…]
# Runs a Windows program under Wine, in a prefix of its own that is made on first use. Programs that draw need a display
# (xvfb-run). HAIRLOOM_CACHE names the folder that holds the prefix.
set -euo pipefail
cache=${HAIRLOOM_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/hairloom}
mkdir -p "$cache"
export WINEPREFIX=$cache/wine WINEARCH=win64 WINEDEBUG=${WINEDEBUG:--all}
# Names of files are UTF-8 for Wine only where they are for the system.
export LC_ALL=C.UTF-8
# No .NET, no browser, no menu entries, no debugger that looks at crashes before their parent does. Microsoft's shader
# compiler, loaded by its path, may replace Wine's.
export WINEDLLOVERRIDES="mscoree,mshtml=;winemenubuilder.exe,winedbg.exe=d;d3dcompiler_47=n,b"
if [ ! -f "$WINEPREFIX/.ready" ]; then
    (
        flock 9
        [ -f "$WINEPREFIX/.ready" ] && exit
        wine wineboot --init > /dev/null 2>&1
        wineserver -w
        # Windows' dialogs are set in Tahoma, which Wine finds only here. Whatever font stands in for it may have
        # metrics of another kind: with those of a font of formulas, text leaves its field.
        ln -sf /usr/share/wine/fonts/tahoma*.ttf "$WINEPREFIX/drive_c/windows/Fonts/"
        touch "$WINEPREFIX/.ready"
    ) 9> "$cache/wine.lock"
fi
# A server that goes as soon as nobody needs it may be on its way out when the next program looks for it: that program
# fails. One that waits is there for all programs of a build. Of one that runs already this says nothing, and ends with 2.
# Wine's services begin with the first program and keep its output open: who waits for the end of that would wait for theirs.
(
    flock 9
    if wineserver -p60 < /dev/null > /dev/null 2>&1 9>&-; then wine cmd /c exit < /dev/null > /dev/null 2>&1 9>&-; fi
) 9> "$cache/wine.lock" || true
exec wine "$@"
