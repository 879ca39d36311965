#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# make_hairstyle.sh [--project-only] [--spheres-only] STYLE OUT: makes one of the sample hairstyles from nothing into the folder
# OUT and says what each step took. STYLE names a file of samples/hairstyles. --project-only stops before anything is simulated,
# exported or drawn. --spheres-only leaves the skin collider out, for what knows spheres alone. The programs must be built
# (./dev build).
set -euo pipefail

project_only=no spheres_only=no
while [[ ${1-} == --* ]]; do
    case $1 in
        --project-only) project_only=yes ;;
        --spheres-only) spheres_only=yes ;;
        *) echo "error: no option '$1'" >&2; exit 2 ;;
    esac
    shift
done
style=${1:?a style: short, shoulder, long, bob, afro or braid}
top=$(cd "$(dirname "$(readlink -f "$0")")/.." && pwd)
mkdir -p "${2:?a folder for the results}"
out=$(cd "$2" && pwd)
cli=${HAIRLOOM_CLI:-$top/build/release/bin/hairloom-cli}
[ -f "$top/samples/hairstyles/$style.conf" ] || { echo "error: no style '$style' in samples/hairstyles" >&2; exit 2; }

# scalp, count, length, follow: set by the style
# shellcheck source=/dev/null
. "$top/samples/hairstyles/$style.conf"

step() {
    local what=$1 begin=$EPOCHREALTIME
    shift
    "$cli" "$@" >"$out/log.txt" || { cat "$out/log.txt" >&2; echo "error: step '$what' failed" >&2; exit 1; }
    awk -v what="$what" -v a="$begin" -v b="$EPOCHREALTIME" 'BEGIN { printf "  %-52s %7.2f s\n", what, b - a }'
}

# page STYLE WEB: what there is, as a page.
page() {
    local style=$1 web=$2
    row() { printf '<tr><td><a href="%s">%s</a></td><td>%s</td></tr>\n' "$1" "$1" "$2"; }
    cat <<HTML
<!DOCTYPE html>
<html lang="en"><meta charset="utf-8"><title>Hairloom: $style</title>
<style>body{font:16px/1.5 sans-serif;max-width:66rem;margin:2rem auto;padding:0 1rem;background:#1e1f22;color:#ddd}
a{color:#8ab4f8}img{width:49%}td{padding:.2rem 1.5rem .2rem 0}code{background:#333;padding:.1rem .3rem}</style>
<h1>The sample hairstyle <em>$style</em></h1>
<p><img src="$style.png" alt="at rest"> <img src="$style-motion.png" alt="moving, in wind"></p>
<table>
HTML
    row "$style.hairloom" "The project. Open it in the editor: <code>build/release/bin/hairloom out/$style.hairloom</code>"
    row "$style.hairrt" "The runtime asset. A game plays it with the library in <code>runtime/</code> (docs/integrate.md)."
    row "$style-unreal.abc" "For Unreal: import it as a groom."
    row "$style.glb" "Hair cards with textures, a skeleton and levels of detail, for any engine that reads glTF."
    row "$style.tfx" "For TressFX."
    row "$style.hair" "Yuksel's format, which Blender add-ons and renderers read."
    row "$style.frames" "Two seconds of simulated motion, as recorded by <code>hairloom-cli simulate</code>."
    if [ "$web" = yes ]; then
        row "$style-web/index.html" "The hair in your browser."
    else
        printf '<tr><td>in your browser</td><td>Build the player with <code>./dev web</code>, then run <code>hairloom-cli export %s --format web -o out/%s-web</code></td></tr>\n' \
            "out/$style.hairloom" "$style"
    fi
    printf '</table></html>\n'
}

cd "$top"   # so that the project names its character file from the top of the repository
echo "Making the sample '$style':"
step "head, scalp, roots, strands" create --mesh samples/bust/bust.glb --scalp "$scalp" --count "$count" \
    --placement dart --length "$length" --points 24 --seed 1 -o "$out/$style.hairloom"
step "grooming" groom "$out/$style.hairloom" --script "samples/hairstyles/$style.json" -o "$out/$style.hairloom"
step "collision spheres" spheres "$out/$style.hairloom" --from samples/bust/spheres.json --replace -o "$out/$style.hairloom"
step "simulation and material settings" set "$out/$style.hairloom" --from "samples/hairstyles/$style.settings.json" \
    -o "$out/$style.hairloom"
if [ "$spheres_only" = no ]; then
    step "skin collider" colliders "$out/$style.hairloom" --fit field -o "$out/$style.hairloom"
fi
if [ "$project_only" = no ]; then
    step "two seconds of head motion in wind" simulate "$out/$style.hairloom" --frames 60 --fps 30 \
        --motion clip:nod_and_turn --wind "$wind" --record "$out/$style.frames"
    step "picture at rest" render "$out/$style.hairloom" --size 1024x1024 --camera three-quarter --exposure 1.6 -o "$out/$style.png"
    step "picture in motion" render "$out/$style.hairloom" --record "$out/$style.frames" --frame 12 --size 1024x1024 \
        --camera three-quarter --exposure 1.6 -o "$out/$style-motion.png"
    step "for games: runtime asset .hairrt" export "$out/$style.hairloom" --format runtime -o "$out/$style.hairrt"
    step "for Unreal: Alembic groom" export "$out/$style.hairloom" --format abc-unreal -o "$out/$style-unreal.abc"
    step "for any engine: glTF cards" export "$out/$style.hairloom" --format gltf -o "$out/$style.glb"
    step "for TressFX: .tfx" export "$out/$style.hairloom" --format tfx -o "$out/$style.tfx"
    step "for other tools: Yuksel .hair" export "$out/$style.hairloom" --format hair -o "$out/$style.hair"
    web=no
    if "$cli" export "$out/$style.hairloom" --format web -o "$out/$style-web" >/dev/null 2>&1; then web=yes; fi
    page "$style" "$web" > "$out/index.html"
fi
rm -f "$out/log.txt"
echo "Results in $out:"
ls -l "$out" | awk -v style="$style" '$9 ~ "^" style { printf "  %-40s %9.1f kB\n", $9, $5 / 1024 }'
