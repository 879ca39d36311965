#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# make_levels.sh [STYLE...]: makes the tables and pictures of docs/levels.md anew: the chain of each sample and, where
# ../shared/data has her, of Sintel; or of the styles that are named. Takes about ten minutes on two cores.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../.."
cli=build/release/bin/hairloom-cli
out=out/levels
sintel=../shared/data/strands/sintel_16pt.tfx
mkdir -p "$out"

# Puts a text in place of what stands between the marks of that name in the page.
putBetween() {
    awk -v name="$1" -v file="$2" '
        $0 == "<!-- " name " -->" { print; while ((getline line < file) > 0) print line; skipping = 1; next }
        $0 == "<!-- end -->" { skipping = 0 }
        !skipping' docs/levels.md > "$out/levels.md"
    cp "$out/levels.md" docs/levels.md
}

[ $# -gt 0 ] || set -- short shoulder long sintel
for style; do
    if [ "$style" = sintel ]; then
        [ -f "$sintel" ] || continue
        groom=$sintel
    else
        samples/make_hairstyle.sh --project-only --spheres-only "$style" "$out"
        groom=$out/$style.hairloom
    fi
    "$cli" lod "$groom" -o "$out/$style" --json > "$out/$style.json"
    cp "$out/$style/chain.png" "docs/pictures/levels-$style.png"
    python3 - "$out/$style" "$out/$style.json" > "$out/$style.md" <<'END'
import json, pathlib, sys
report = json.load(open(sys.argv[2]))
print()
print(pathlib.Path(sys.argv[1], "levels.md").read_text(), end="")
print()
words = f"The largest step of light is {100 * report['largest_light_step']:.1f} %."
springs = report["springs"]
if springs:
    words += (f" Springs keep joints {springs['error_mm']:.1f} mm from the strands while the head nods, {springs['largest_mm']:.0f} mm at most"
              f" ({springs['default_error_mm']:.1f} and {springs['default_largest_mm']:.0f} mm unfitted).")
print(words)
END
    putBetween "$style" "$out/$style.md"
done
