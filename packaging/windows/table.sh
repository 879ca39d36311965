#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: packaging/windows/table.sh RESULTS.tsv [PAGE.md]
# The results of verify.sh as a table in Markdown, a row for each feature and a column for each backend, with the seconds that it
# took; with PAGE, in place of the table that stands there between the lines "<!-- table -->" and "<!-- end of table -->".
set -euo pipefail

table() {
    awk -F '\t' '
        !($1 in seen) { seen[$1] = 1; features[++rows] = $1 }
        { cell[$1, $2] = $3 ($4 == "" ? "" : ": " $4); if ($3 == "passed" && $4 != "") cell[$1, $2] = $4
          cell[$1, $2] = cell[$1, $2] ", " $5 " s" }
        END {
            count = split("CPU|Vulkan|Direct3D 11 by OpenGL|Direct3D 11 by Vulkan", backends, "|")
            printf "| what |"; for (b = 1; b <= count; ++b) printf " %s |", backends[b]
            printf "\n|---|"; for (b = 1; b <= count; ++b) printf "---|"
            printf "\n"
            for (r = 1; r <= rows; ++r) {
                printf "| %s |", features[r]
                for (b = 1; b <= count; ++b)
                    printf " %s |", (features[r], backends[b]) in cell ? cell[features[r], backends[b]] : "–"
                printf "\n"
            }
        }' "$1"
}

if [ $# -eq 1 ]; then
    table "$1"
    exit
fi
grep -q '^<!-- table -->$' "$2" && grep -q '^<!-- end of table -->$' "$2" || { echo "error: $2 has no place for the table" >&2; exit 1; }
written=$(mktemp)
{
    sed '/^<!-- table -->$/q' "$2"
    table "$1"
    sed -n '/^<!-- end of table -->$/,$p' "$2"
} > "$written"
cat "$written" > "$2"
rm "$written"
