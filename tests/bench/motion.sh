#!/bin/sh
# motion.sh BUILD [OPTION...]: what noise does over a shot and on flat patches (tests/bench/motion.c), for every quality, as Markdown in
# BUILD/bench/motion.md. SIZE: 480x270. QUALITIES: "draft standard high". BIN: the program, instead of BUILD's.
set -eu
build=$1
shift
size=${SIZE:-480x270}
width=${size%x*} height=${size#*x}
bin=${BIN:-$build/ssdo-filter}
tool=$build/tests/bench/motion
dir=$build/bench/motion/$size
mkdir -p "$dir"
[ -e "$dir/in.8.exr" ] || "$tool" write "$width" "$height" "$dir"
{
    echo "| size | quality | layer | change in motion, rms | residual on flat patches, % |"
    echo "| --- | --- | --- | ---: | ---: |"
    for quality in ${QUALITIES:-draft standard high}; do
        "$bin" -q "$dir/in.#.exr" -o "$dir/$quality.#.exr" --frames 1-8 --layers occlusion,radiance,indirect --keep none --float \
            --env "${SKY:-samples/sky_soft.exr}" --outside open --quality "$quality" "$@" >&2
        "$tool" score "$width" "$height" "$dir" "$quality" |
            awk -F '\t' -v size="$size" -v q="$quality" '{ printf "| %s | %s | %s | %.4f | %.2f |\n", size, q, $1, $2, 100 * $3 }'
    done
} >"$build/bench/motion.md"
cat "$build/bench/motion.md"
