#!/bin/sh
# flat.sh BUILD [OPTION...]: what is left of the noise on the flat patches of the rendered samples (tests/bench/motion.c), as Markdown in
# BUILD/bench/flat.md. QUALITIES: "draft standard". BIN: the program, instead of BUILD's.
set -eu
build=$1
shift
mkdir -p "$build/bench"
{
    echo "| sample | quality | layer | residual on flat patches, % | beyond the truth, % | patches |"
    echo "| --- | --- | --- | ---: | ---: | ---: |"
    for quality in ${QUALITIES:-draft standard}; do
        out=$build/bench/flat/$quality
        sh tests/bench/covered.sh "$build" samples "$out" --float --quality "$quality" "$@" >"$build/bench/flat.log"
        "$build/tests/bench/motion" flat samples "$out" |
            awk -F '\t' -v q="$quality" '{ printf "| %s | %s | %s | %.2f | %.2f | %s |\n", $1, q, $2, 100 * $3, 100 * $4, $5 }'
    done
} >"$build/bench/flat.md"
cat "$build/bench/flat.md"
