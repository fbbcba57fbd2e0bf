#!/bin/sh
# paste.sh TABLE NAME FILE: replaces what stands in FILE between the lines "<!-- NAME -->" and "<!-- /NAME -->" by TABLE.
set -eu
[ -s "$1" ] || { echo "paste: there is no $1; run make $2 first" >&2; exit 1; }
grep -qx "<!-- $2 -->" "$3" && grep -qx "<!-- /$2 -->" "$3" || { echo "paste: $3 has no marks <!-- $2 -->" >&2; exit 1; }
awk -v table="$1" -v name="$2" '
    $0 == "<!-- /" name " -->" { inside = 0 }
    !inside { print }
    $0 == "<!-- " name " -->" { inside = 1; while ((getline line < table) > 0) print line }' "$3" >"$3.tmp"
mv "$3.tmp" "$3"
