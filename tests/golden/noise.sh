#!/bin/sh
# What noise does over a shot and on flat patches stays below what is promised (tests/bench/motion.c says how it is measured).
set -u
build=$(dirname "$SSDO")
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT

mkdir -p "$dir/tests/bench" && cp "$build/tests/bench/motion" "$build/tests/bench/score" "$dir/tests/bench" || exit 1
BIN=$SSDO QUALITIES='draft standard' sh tests/bench/motion.sh "$dir" >"$dir/table" || exit 1
# Limits: of occlusion in motion; of the residual, in per cent, a draft's three times the default's. Of light in motion: what was measured,
# and a fifth.
awk -F ' *[|] *' '
    function hold(what, value, limit) { if (!(value <= limit)) { print "FAILED: " $3 " " $4 ": " what " " value " > " limit; bad = 1 } }
    NR > 2 {
        draft = $3 == "draft"
        most = $4 == "occlusion" ? (draft ? .02 : .012) : $4 == "radiance" ? (draft ? .039 : .020) : (draft ? .062 : .031)
        hold("motion", $5, most)
        hold("residual", $6, ($4 == "indirect" ? 5 : 1) * (draft ? 3 : 1))
        rows++
    }
    END { if (rows != 6) { print "FAILED: " rows " rows"; bad = 1 } exit bad }' "$dir/table" || { cat "$dir/table"; exit 1; }
awk 'NR > 2 { printf "figure: noise %s\n", $0 }' "$dir/table"

# The rendered samples. Radiance is not held where flat patches show edges of the shadows of suns.
BIN=$SSDO sh tests/bench/flat.sh "$dir" >"$dir/flat" || exit 1
awk -F ' *[|] *' '
    NR > 2 && ($4 != "radiance" || $2 == "still" || $2 == "box") {
        most = ($4 == "indirect" ? 5 : 1) * ($3 == "draft" ? 3 : 1)
        if (!($5 <= most)) { print "FAILED: " $2 " " $3 " " $4 ": residual " $5 " > " most; bad = 1 }
        rows++
    }
    END { if (rows != 20) { print "FAILED: " rows " rows of flat patches"; bad = 1 } exit bad }' "$dir/flat" || { cat "$dir/flat"; exit 1; }
