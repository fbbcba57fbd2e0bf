#!/bin/sh
# front.sh BUILD OLD: error against time of two programs, BUILD's and OLD (an older ssdo-filter that lies beside its modules), at several
# budgets: CPU of a whole job of 960x540 pixels, beside copying its file, and the errors of the samples by tests/bench/covered.sh. As Markdown in
# BUILD/bench/front.md, as a plot in BUILD/bench/front.png. ROUNDS: 3.
set -eu
build=$1 old=$2
dir=$build/bench/front
mkdir -p "$dir"
in=$dir/in.exr
[ -e "$in" ] || "$build/tests/bench/make_input" 960 540 "$in" >&2
program() { if [ "$1" = old ]; then echo "$old"; else echo "$build/ssdo-filter"; fi; }
: >"$dir/errors"
set -- copy "oiiotool $in -o $dir/copy.exr"
for row in old:16:half old:32:half old:64:half old:16:full old:32:full old:64:full \
    new:16:half new:32:half new:64:half new:16:light new:32:light new:64:light new:64:full; do
    bin=$(program "${row%%:*}") size=${row##*:} samples=${row#*:}
    options="--samples ${samples%:*} --resolution $size"
    # shellcheck disable=SC2086
    BIN=$bin SCENES='still horizon thin box ortho' sh tests/bench/covered.sh "$build" samples "$dir/layers" $options |
        awk -F ' *[|] *' -v row="$row" '$2 == "mean" { print row "\t" $3 "\t" $7 "\t" $11 }' >>"$dir/errors"
    set -- "$@" "$row" "$bin -q $in -o $dir/out.exr --env samples/sky_soft.exr --env-up z --outside open $options"
done
"$build/tests/bench/measure" "${ROUNDS:-3}" "$@" >"$dir/times"
sh tests/bench/front_table.sh "$build"
