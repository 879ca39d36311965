#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# farm.sh CLI OPENJD OUT: runs a sweep of storms and one of caches with hairloom-cli CLI here, on a Slurm of two nodes of which one is killed
# during the run, and by the runner OPENJD, all below OUT, and compares what they merge byte by byte. Needs root and Slurm's daemons.
set -euo pipefail
cli=$(readlink -f "${1:?hairloom-cli}")
openjd=$(readlink -f "$(dirname "${2:?openjd}")")/$(basename "$2")
top=$(cd "$(dirname "$(readlink -f "$0")")/../.." && pwd)
rm -rf "${3:?a folder}" && mkdir -p "$3" && out=$(cd "$3" && pwd)
storms=${HAIRLOOM_FARM_STORMS:-400}
# shellcheck source=cluster.sh
. "$top/tests/farm/cluster.sh" "$out/cluster"

failed=0
say() { printf '\033[1m%s\033[0m\n' "$*" >&2; }
same() {
    local file
    for file in "${@:3}"; do
        if cmp "$1/$file" "$2/$file"; then
            echo "same bits: $(basename "$1") and $(basename "$2"): $file"
        else
            failed=1
        fi
    done
}
counts() { "$cli" sweep "$1" -o "$2" --status --json | tr -d ' \n' | grep -oE '"(done|failed|missing)":[0-9]+' | tr '\n' ' '; }

HAIRLOOM_CLI=$cli "$top/samples/make_hairstyle.sh" --project-only shoulder "$out" >/dev/null
cat > "$out/storms.json" <<JSON
{"hairloom_sweep": 1, "job": "stability",
 "arguments": {"groom": "shoulder.hairloom", "output": "{out}", "storms": $((storms / 20)), "first-storm": "{first}"},
 "over": [{"name": "first", "from": 0, "to": $((storms - storms / 20)), "step": $((storms / 20))}]}
JSON
cat > "$out/caches.json" <<'JSON'
{"hairloom_sweep": 1, "job": "simulate", "gather": true,
 "arguments": {"groom": "shoulder.hairloom", "motion": "{motion}", "wind": "{wind}", "frames": 10, "record": "{out}/{motion}-{wind}.frames"},
 "over": [{"name": "motion", "values": ["nod", "spin"]}, {"name": "wind", "values": ["0,0,0", "6,0,2"]}]}
JSON
results=(merged.json table.csv manifest.json manifest.xxh3)

say "Here"
for sweep in storms caches; do "$cli" sweep "$out/$sweep.json" -o "$out/here-$sweep" --progress lines >/dev/null; done

say "On Slurm, with a node that is killed"
trap clusterDown EXIT
clusterUp
for sweep in storms caches; do
    "$cli" sweep "$out/$sweep.json" -o "$out/slurm-$sweep" --slurm --chunk 2 --json > "$out/$sweep-jobs.json"
done
jobOf() { sed -n "s/.*\"$2\": \"\([0-9]*\)\".*/\1/p" "$out/$1-jobs.json"; }
array=$(jobOf storms array_job)
# In the midst of the node's work.
taskOf() { squeue -h -j "$array" -t R -w "$1" -o '%A' | head -1; }
busy() { [ -n "$(taskOf n2)" ]; }
waitFor "task on n2" busy
nodeDies n2
echo "killed n2 with $(counts "$out/storms.json" "$out/slurm-storms")"
ended() { [ -z "$(squeue -h -o %A)" ]; }
for ((minute = 0; minute < 15; minute++)); do waitFor "end of the queue" ended 2>/dev/null && break; done
ended || { echo "error: the queue does not end" >&2; squeue >&2; exit 1; }
sinfo -h -N -o '%N is %T'
grep -l "" "$out"/slurm-storms/slurm/*.log | wc -l | sed 's/$/ logs of storms/'
for sweep in storms caches; do
    [ -f "$out/slurm-$sweep/merged.json" ] || cat "$out/slurm-$sweep"/slurm/merge_*.log >&2
    same "$out/here-$sweep" "$out/slurm-$sweep" "${results[@]}"
done
same "$out/here-storms" "$out/slurm-storms" certificates.json
clusterDown
trap - EXIT

say "By openjd-cli"
"$cli" sweep "$out/storms.json" -o "$out/openjd-storms" --openjd "$out/openjd" --chunk 6 >/dev/null
"$openjd" check "$out/openjd/template.json"
for step in Parts Merge; do "$openjd" run "$out/openjd/template.json" --step "$step" > "$out/openjd/$step.log" 2>&1 || { tail -30 "$out/openjd/$step.log" >&2; exit 1; }; done
grep -c "openjd_progress" "$out/openjd/Parts.log" | sed 's/$/ lines of progress/'
same "$out/here-storms" "$out/openjd-storms" "${results[@]}" certificates.json

(cd "$out/here-caches" && xxhsum --check manifest.xxh3)
[ "$failed" -eq 0 ] || { echo "error: results differ" >&2; exit 1; }
say "The farm gives the same bits"
