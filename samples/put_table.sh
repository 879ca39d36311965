#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# put_table.sh TABLE PAGE [MARK]: the table replaces what stands between the marks MARK ("measured") and "end" of the page.
set -euo pipefail

replaced=$(awk -v table="$1" -v mark="<!-- ${3:-measured} -->" '
    $0 == mark { print; print ""; while ((getline line < table) > 0) print line; print ""; skip = 1; next }
    /^<!-- end -->$/ { skip = 0 }
    !skip { print }' "$2")
printf '%s\n' "$replaced" > "$2"
