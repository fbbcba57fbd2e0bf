#!/bin/sh
# mutate.sh BUILD SECONDS: files of every compression with some bytes changed, cut short or repeated, as input or as environment,
# through the whole program built with the sanitizers (BUILD/asan). Each run ends with a documented exit code, no report of a
# sanitizer, and a whole output or none.
set -u
build=$1 ssdo=$1/asan/ssdo-filter seconds=$2
[ -x "$ssdo" ] || { echo "no $ssdo: make BUILD=$build/asan SANITIZE=address,undefined all"; exit 77; }
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
here=$(dirname "$0")
ASAN_OPTIONS=allocator_may_return_null=1:exitcode=99:detect_leaks=0 UBSAN_OPTIONS=halt_on_error=1:exitcode=99
export ASAN_OPTIONS UBSAN_OPTIONS
kinds="none rle zips zip piz pxr24 b44 b44a dwaa dwab"
oiiotool samples/still.exr --cut 40x40+200+120 --origin +0+0 --fullpixels -o "$dir/in.exr" >/dev/null || exit 1
for kind in $kinds; do
    oiiotool "$dir/in.exr" --compression $kind -o "$dir/$kind.exr" >/dev/null || exit 1
    oiiotool "$dir/$kind.exr" --tile 16 16 --compression $kind -o "$dir/$kind-tiled.exr" >/dev/null || exit 1
done
end=$(($(date +%s) + seconds)) runs=0 read=0 seed=1 round=0
while [ "$(date +%s)" -lt $end ]; do
    round=$((round + 1))
    for f in "$dir"/*[0-9a-z].exr; do
        case $f in */in.exr|*/bad.exr|*/out.exr) continue ;; esac
        [ "$(date +%s)" -lt $end ] || break
        seed=$((seed + 1))
        python3 "$here/mutate.py" "$f" "$dir/bad.exr" $seed
        rm -f "$dir/out.exr"
        # One in four is the environment of a good frame.
        if [ $(((seed + round) % 4)) = 3 ]; then set -- "$dir/in.exr" --env "$dir/bad.exr"; else set -- "$dir/bad.exr"; fi
        timeout -k 1 120 nice -n "${FUZZ_NICE:-19}" "$ssdo" -q "$@" -o "$dir/out.exr" --samples 1 --threads 2 --verify \
            --layers occlusion,radiance --layout "$([ $((round % 2)) = 0 ] && echo single || echo multipart)" >"$dir/log" 2>&1
        code=$?
        [ -z "${FUZZ_TRACE:-}" ] || echo "$(basename $f) $seed $code $(cut -c1-150 "$dir/log" | head -1)"
        runs=$((runs + 1))
        case $code in
        0) read=$((read + 1)); [ -s "$dir/out.exr" ] || code=bad ;;
        2|3|4|6) [ ! -e "$dir/out.exr" ] && [ "$(grep -c '^ssdo-filter: ' "$dir/log")" = 1 ] || code=bad ;;
        *) code=bad ;;
        esac
        if [ $code = bad ]; then
            mkdir -p "$build/fuzz/crashes" && cp "$dir/bad.exr" "$build/fuzz/crashes/program-$seed.exr"
            head -60 "$dir/log"
            echo "FAILED: $(basename "$f"), seed $seed: the file is in $build/fuzz/crashes"
            exit 1
        fi
    done
done
echo "figure: whole program: $runs mutated files of 10 compressions, scanline and tiled, in $seconds s: $read filtered, $((runs - read)) refused, 0 reports"
