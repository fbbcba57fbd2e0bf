#!/bin/sh
# run.sh BUILD SECONDS [TARGET...]: builds the fuzz targets with clang's libFuzzer, address and undefined-behaviour sanitizers, lets
# each run for its share of the time at low priority, and says how it went. Without names: exr and frames. They start from
# tests/fuzz/corpus and what make_corpus writes; new inputs stay in BUILD/fuzz/corpus-*, crashing ones in BUILD/fuzz/crashes.
# `program` is no libFuzzer target: mutate.sh drives the whole program. On a machine that others use too, FUZZ_NICE=5 gets a fair
# share of it, FUZZ_TIMEOUT=60 leaves an input 60 s instead of 10; the figures say how much of the processor there was.
set -eu
top=$1 build=$1/fuzz seconds=$2
shift 2
[ $# -gt 0 ] || set -- exr frames
cc=${FUZZ_CC:-clang}
command -v "$cc" >/dev/null 2>&1 || { echo "fuzz: no $cc here (Debian: clang libclang-rt-dev)"; exit 77; }
flags="-std=c17 -D_GNU_SOURCE -DSSDO_VERSION=\"fuzz\" -Isrc -g -O1 -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined"
packages="OpenEXR libdeflate json-c"
system=$(pkg-config --cflags $packages | sed 's/-I/-isystem /g')
libs="-Wl,--as-needed $(pkg-config --libs $packages) -lm -ldl -lpthread"
mkdir -p "$build/crashes" "$build/objects"

# Shares of a hundred, and the longest input.
share() {
    case $1 in
    exr) echo 35 ;; mesh) echo 15 ;; json) echo 10 ;; args) echo 10 ;; attributes) echo 10 ;; frames) echo 3 ;; program) echo 17 ;;
    esac
}
longest() { case $1 in exr) echo 32768 ;; mesh) echo 8192 ;; *) echo 2048 ;; esac; }

echo "fuzz: building"
for f in src/base/*.c src/exr/*.c src/plugin/*.c src/gbuffer/*.c src/light/*.c src/cli/*.c; do
    o=$build/objects/$(echo "$f" | tr / _).o
    [ "$o" -nt "$f" ] || $cc $flags $system -c "$f" -o "$o"
done
total=0
for t in "$@"; do
    total=$((total + $(share "$t")))
    [ "$t" = program ] && continue
    $cc $flags -fsanitize=fuzzer $system "tests/fuzz/fuzz_$t.c" "$build"/objects/*.o -o "$build/fuzz_$t" $libs
    mkdir -p "$build/corpus-$t"
    [ ! -d "tests/fuzz/corpus/$t" ] || cp tests/fuzz/corpus/"$t"/* "$build/corpus-$t"
done
[ ! -d "$build/corpus-exr" ] || "$top/tests/make_corpus" "$build/corpus-exr"
[ ! -d "$build/corpus-exr" ] || oiiotool "$build/corpus-exr/kind3.exr" --tile 8 8 -o "$build/corpus-exr/tiled.exr" >/dev/null 2>&1 || true

cpu() { # sets `used`: all seconds of processor time of this shell's children
    times >"$build/times"
    used=$(tail -1 "$build/times" | sed 's/[ms]/ /g' | awk '{ printf "%d", 60 * $1 + $2 + 60 * $3 + $4 }')
}
go() { # TARGET SECONDS MAX_LENGTH
    code=0
    cpu
    before=$used
    nice -n "${FUZZ_NICE:-19}" "$build/fuzz_$1" "$build/corpus-$1" -max_total_time="$2" -rss_limit_mb=2048 -timeout="${FUZZ_TIMEOUT:-10}" -max_len="$3" -print_final_stats=1 \
        -artifact_prefix="$build/crashes/" >"$build/$1.log" 2>&1 || code=$?
    cpu
    runs=$(sed -n 's/^stat::number_of_executed_units: //p' "$build/$1.log" | tail -1)
    peak=$(sed -n 's/^stat::peak_rss_mb: *//p' "$build/$1.log" | tail -1)
    edges=$(grep -ao 'cov: [0-9]*' "$build/$1.log" | tail -1 | cut -c6-)
    echo "figure: fuzz_$1: ${runs:-no} executions in $2 s ($((used - before)) s of processor time), ${edges:-0} edges covered, peak ${peak:-?} MB, $([ $code = 0 ] && echo 0 crashes || echo CRASHED)"
    [ $code = 0 ] || { tail -40 "$build/$1.log"; exit 1; }
}
for t in "$@"; do
    time=$((seconds * $(share "$t") / total))
    [ $time -gt 0 ] || time=1
    if [ "$t" = program ]; then sh tests/fuzz/mutate.sh "$top" $time; else go "$t" $time "$(longest "$t")"; fi
done
