#!/bin/sh
# frame.sh BUILD [ROUNDS]: what a whole frame costs beside copying the file (`make bench-frame`). Writes BUILD/bench/frame.md.
# CPU is user + system of the process; commands run in turn, medians; ratios are to `oiiotool in.exr -o copy.exr`.
set -eu
build=$1
rounds=${2:-3}
bin=$build/ssdo-filter
dir=$build/bench/frame
mkdir -p "$dir"
out=$build/bench/frame.md
env=samples/sky_soft.exr
{
    echo "| size | command | CPU ms | wall ms | CPU, x oiiotool | CPU spread % | peak MiB |"
    echo "| --- | --- | ---: | ---: | ---: | ---: | ---: |"
} >"$out"
for size in ${SIZES:-960x540 1920x1080 3840x2160}; do
    in=$dir/$size.exr
    [ -e "$in" ] || "$build/tests/bench/make_input" "${size%x*}" "${size#*x}" "$in"
    one() { echo "$bin -q $in -o $dir/out.exr --env $env $*"; }
    "$build/tests/bench/measure" "$rounds" \
        "oiiotool copy" "oiiotool $in -o $dir/copy.exr" \
        "OpenEXRCore read + write" "$build/tests/bench/core_copy $in $dir/copy.exr" \
        "cp" "cp $in $dir/copy.exr" \
        "four layers, draft" "$(one --quality draft)" \
        "four layers, standard" "$(one --quality standard)" \
        "four layers, ssdo" "$(one --method ssdo)" \
        "occlusion only, keep none, draft" "$(one --quality draft --layers occlusion --keep none)" |
        awk -F '\t' -v size="$size" 'NR == 1 { base = $2 } { printf "| %s | %s | %s | %s | %.2f | %s | %s |\n", size, $1, $2, $3, $2 / base, $4, $5 }' >>"$out"
done
cat "$out"
