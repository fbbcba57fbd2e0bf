#!/bin/sh
# threads.sh BUILD: the batch path (read ahead, filter, write behind, chunk threads) of a program built with SANITIZE=thread. Fails on
# any report; the driver's own noise is suppressed (mesa.supp), frames of ours never are.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
mkdir "$dir/in" "$dir/out"
for i in 1 2 3 4 5; do oiiotool samples/still.exr --cut "96x72+$((80 * i))+120" --origin +0+0 --fullpixels -o "$dir/in/f.000$i.exr" || exit 1; done
for transfer in direct mapped; do # as on a software renderer and as on hardware
    rm -f "$dir"/out/*
    SSDO_TRANSFER=$transfer TSAN_OPTIONS="suppressions=$(dirname "$0")/mesa.supp exitcode=66 history_size=4" "$1/ssdo-filter" "$dir/in/f.####.exr" \
        -o "$dir/out/f.####.exr" --env samples/sky_soft.exr --samples 8 --threads 4 >"$dir/log" 2>&1
    code=$?
    reports=$(grep -c 'WARNING: ThreadSanitizer' "$dir/log")
    written=$(ls "$dir/out" | wc -l)
    [ $code = 0 ] && [ "$reports" = 0 ] && [ "$written" = 5 ] || { cat "$dir/log"; echo "FAILED: exit $code, $reports reports, $written frames"; exit 1; }
done
echo "figure: thread sanitizer: $written frames in a batch, 4 threads, layers copied and through mapped buffers: $reports reports"
