#!/bin/sh
# run.sh BUILD SECONDS: builds the fuzz targets with clang's libFuzzer, address and undefined-behaviour sanitizers, lets each run for
# its share of the time (nine tenths the EXR target) at low priority, and says how it went. New inputs stay in BUILD/fuzz/corpus-*,
# crashing ones in BUILD/fuzz/crashes.
set -eu
build=$1/fuzz seconds=$2
cc=${FUZZ_CC:-clang}
command -v "$cc" >/dev/null 2>&1 || { echo "fuzz: no $cc here (Debian: clang libclang-rt-dev)"; exit 77; }
mkdir -p "$build/corpus-exr" "$build/corpus-frames" "$build/crashes"
flags="-std=c17 -D_GNU_SOURCE -DSSDO_VERSION=\"fuzz\" -Isrc -g -O1 -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=undefined"
packages="OpenEXR libdeflate json-c"
system=$(pkg-config --cflags $packages | sed 's/-I/-isystem /g')
echo "fuzz: building"
$cc $flags $system tests/fuzz/fuzz_exr.c src/base/*.c src/exr/*.c src/plugin/*.c src/gbuffer/*.c -o "$build/fuzz_exr" -Wl,--as-needed \
    $(pkg-config --libs $packages) -lm -ldl -lpthread
$cc $flags tests/fuzz/fuzz_frames.c src/base/*.c src/cli/frames.c -o "$build/fuzz_frames" -lm -lpthread
"$1/tests/make_corpus" "$build/corpus-exr"
oiiotool "$build/corpus-exr/kind3.exr" --tile 8 8 -o "$build/corpus-exr/tiled.exr" >/dev/null 2>&1 || true
printf '1-100x2, 1-10:4,7,-5--1%%8\nshot.####.exr' >"$build/corpus-frames/a"
printf '10-1x3\nf.%%04d.exr' >"$build/corpus-frames/b"
printf '0-15:4%%4\n/a/b.$F4.exr' >"$build/corpus-frames/c"

go() { # TARGET SECONDS MAX_LENGTH
    code=0
    nice -n 19 "$build/fuzz_$1" "$build/corpus-$1" -max_total_time="$2" -rss_limit_mb=2048 -timeout=10 -max_len="$3" -print_final_stats=1 \
        -artifact_prefix="$build/crashes/" >"$build/$1.log" 2>&1 || code=$?
    runs=$(sed -n 's/^stat::number_of_executed_units: //p' "$build/$1.log")
    peak=$(sed -n 's/^stat::peak_rss_mb: *//p' "$build/$1.log")
    edges=$(grep -o 'cov: [0-9]*' "$build/$1.log" | tail -1 | cut -c6-)
    echo "figure: fuzz_$1: ${runs:-no} executions in $2 s, ${edges:-0} edges covered, peak ${peak:-?} MB, $([ $code = 0 ] && echo 0 crashes || echo CRASHED)"
    [ $code = 0 ] || { tail -40 "$build/$1.log"; exit 1; }
}
go exr $((seconds - seconds / 10)) 32768
go frames $((seconds / 10 > 0 ? seconds / 10 : 1)) 256
