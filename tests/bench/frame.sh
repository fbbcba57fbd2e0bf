#!/bin/sh
# frame.sh BUILD [ROUNDS]: what a whole frame costs beside copying the file (`make bench-frame`). Writes BUILD/bench/frame.md.
# CPU is user + system of the process; commands run in turn, ROUNDS times, medians; ratios are to `oiiotool in.exr -o copy.exr`.
# SIZE is the size of the ratios (1920x1080), BIG that of the cost per pixel (3840x2160; empty leaves it out), FRAMES the batch.
# Two inputs: a render with noise, whose copy is dear, and one without, whose copy is cheap. Our work on both is the same.
set -eu
build=$1
rounds=${2:-3}
size=${SIZE:-1920x1080}
big=${BIG-3840x2160}
frames=${FRAMES:-24}
bin=$build/ssdo-filter
tools=$build/tests/bench
dir=$build/bench/frame
env="samples/sky_soft.exr --env-up z" # the still life has z up, and its plain names would count as y up
mkdir -p "$dir/sequence"
out=$build/bench/frame.md
ratios=$dir/ratios
curve=$dir/curve.tsv

input() { # WIDTHxHEIGHT [clean]: its path, made if need be
    file=$dir/$1${2:+-$2}.exr
    [ -e "$file" ] || "$tools/make_input" "${1%x*}" "${1#*x}" "$file" ${2:+"$2"} >&2
    echo "$file"
}
filter() { echo "$bin -q $in -o $dir/out.exr --env $env $*"; }
rows() { # measure's lines as a table; the first is the yardstick
    awk -F '\t' -v size="$1" 'NR == 1 { base = $2 } { printf "| %s | %s | %s | %s | %.2f | %s | %s |\n", size, $1, $2, $3, $2 / base, $4, $5 }' "$2"
}
cpu_of() { awk -F '\t' -v name="$2" '$1 == name { print $2 }' "$1"; }
ratio() { # FILE NAME INPUT TARGET: a line of the second table
    awk -F '\t' -v name="$2" -v input="$3" -v target="$4" 'NR == 1 { base = $2 }
        $1 == name { printf "| %s, %s input, CPU over oiiotool'"'"'s copy | %.2f | %s |\n", name, input, $2 / base, target }' "$1" >>"$ratios"
}

in=$(input "$size")
: >"$ratios"
# Once before all: a farm's machine has compiled the shaders before.
$bin -q "$in" -o "$dir/out.exr" --env $env --quality draft
"$tools/measure" "$rounds" \
    "oiiotool copy" "oiiotool $in -o $dir/copy.exr" \
    "OpenEXRCore read + write" "$tools/core_copy $in $dir/copy.exr >$dir/null" \
    "cp" "cp $in $dir/copy.exr" \
    "four layers, draft" "$(filter --quality draft)" \
    "four layers, standard" "$(filter --quality standard)" \
    "four layers, draft, multipart" "$(filter --quality draft --layout multipart)" \
    "four layers, standard, multipart" "$(filter --quality standard --layout multipart)" \
    "occlusion only, keep none, draft" "$(filter --quality draft --layers occlusion --keep none)" \
    "version" "$bin --version >$dir/null" "help" "$bin --help >$dir/null" >"$dir/main.tsv"
in=$(input "$size" clean)
"$tools/measure" "$rounds" \
    "oiiotool copy" "oiiotool $in -o $dir/copy.exr" \
    "four layers, draft" "$(filter --quality draft)" \
    "four layers, standard" "$(filter --quality standard)" \
    "occlusion only, keep none, draft" "$(filter --quality draft --layers occlusion --keep none)" >"$dir/clean.tsv"
in=$(input "$size")
ratio "$dir/main.tsv" "four layers, draft" noisy 1.0
ratio "$dir/clean.tsv" "four layers, draft" clean 1.8
ratio "$dir/main.tsv" "four layers, standard" noisy 2.9
ratio "$dir/clean.tsv" "four layers, standard" clean 5.0
ratio "$dir/main.tsv" "four layers, draft, multipart" noisy 0.7
ratio "$dir/main.tsv" "four layers, standard, multipart" noisy 1.3
ratio "$dir/main.tsv" "occlusion only, keep none, draft" noisy 0.35
ratio "$dir/clean.tsv" "occlusion only, keep none, draft" clean –

# Decoding the input, encoding the new layers: ours over the library's default, in turn.
$bin -q "$in" -o "$dir/layers.exr" --env $env --quality draft --keep none
: >"$dir/codec"
for i in $(seq "$rounds"); do
    echo "$("$tools/own_copy" "$in" "$dir/copy.exr") $("$tools/core_copy" "$in" "$dir/copy.exr")" \
        "$("$tools/own_copy" "$dir/layers.exr" "$dir/copy.exr") $("$tools/core_copy" "$dir/layers.exr" "$dir/copy.exr")" >>"$dir/codec"
done
median() { sort -n | awk '{ v[NR] = $1 } END { printf "%.2f", v[int((NR + 1) / 2)] }'; }
echo "| decode of the input, CPU over the library's | $(awk '{ print $1 / $3 }' "$dir/codec" | median) | 0.5 |" >>"$ratios"
echo "| encode of the new layers, CPU over the library's | $(awk '{ print $6 / $8 }' "$dir/codec" | median) | 0.3 |" >>"$ratios"

# What accuracy costs: the whole job at several budgets, and the errors that the same settings have on the samples. A draft is 16
# samples at half resolution.
"$build/bench-curve" >"$dir/errors.tsv"
set -- "oiiotool copy" "oiiotool $in -o $dir/copy.exr"
while read -r samples resolution _; do
    set -- "$@" "$samples $resolution" "$(filter --samples "$samples" --resolution "$resolution")"
done <"$dir/errors.tsv"
"$tools/measure" 1 "$@" >"$curve"

# A batch: the same frame under many names.
for i in $(seq "$frames"); do ln -sf "../$size.exr" "$dir/sequence/in.$(printf %04d "$i").exr"; done
batch() { echo "$bin -q $dir/sequence/in.####.exr -o $dir/sequence/out.####.exr --env $env --quality draft --frames 1-$1"; }
# How far the frames in flight overlap is chance, and a longer batch has more chances; so the short one has several.
"$tools/measure" 3 "five" "$(batch 5)" >"$dir/batch.tsv"
"$tools/measure" 1 "all" "$(batch "$frames")" >>"$dir/batch.tsv"
awk -F '\t' -v n="$frames" '$1 == "five" { peak = $5 }
    $1 == "all" {
        printf "| batch of %d, wall over CPU | %.2f | 0.6 |\n", n, $3 / $2
        printf "| batch of %d, peak memory over that of 5 frames | %.2f | 1.0 |\n", n, $5 / peak
    }' "$dir/batch.tsv" >>"$ratios"
rm -f "$dir"/sequence/out.*

if [ -n "$big" ]; then
    # In turn with the smaller size: minutes apart the machine is another one.
    small=$(filter --quality draft)
    in=$(input "$big")
    "$tools/measure" 5 "oiiotool copy" "oiiotool $in -o $dir/copy.exr" "four layers, draft" "$(filter --quality draft)" "small" "$small" >"$dir/big.tsv"
    awk -v a="$(cpu_of "$dir/big.tsv" "four layers, draft")" -v b="$(cpu_of "$dir/big.tsv" small)" -v big="$big" -v size="$size" 'BEGIN {
        split(big, p, "x"); split(size, q, "x")
        printf "| CPU a pixel, %s over %s, draft | %.2f | 1.2 |\n", big, size, a / (p[1] * p[2]) / (b / (q[1] * q[2])) }' >>"$ratios"
fi

{
    echo "| size | command | CPU ms | wall ms | CPU, x oiiotool | CPU spread % | peak MiB |"
    echo "| --- | --- | ---: | ---: | ---: | ---: | ---: |"
    rows "$size" "$dir/main.tsv" | grep -v "| version \|| help "
    rows "$size, clean" "$dir/clean.tsv"
    if [ -n "$big" ]; then rows "$big" "$dir/big.tsv" | grep -v "| small "; fi
    echo
    echo "| ratio | measured | target |"
    echo "| --- | ---: | ---: |"
    cat "$ratios"
    awk -F '\t' '$1 == "version" || $1 == "help" { printf "| `--%s`, CPU ms | %s | 5 |\n", $1, $2 }' "$dir/main.tsv"
    echo
    echo "| samples | resolution | whole job, CPU, x oiiotool | occlusion, rmse | radiance, relative | indirect, relative |"
    echo "| ---: | --- | ---: | ---: | ---: | ---: |"
    awk -F '\t' 'NR == FNR { if (FNR == 1) base = $2; else cpu[$1] = $2 / base; next }
        { printf "| %s | %s | %.2f | %s | %s | %s |\n", $1, $2, cpu[$1 " " $2], $3, $4, $5 }' "$curve" "$dir/errors.tsv"
} >"$out"
cat "$out"
