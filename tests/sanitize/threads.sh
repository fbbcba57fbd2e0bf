#!/bin/sh
# threads.sh BUILD: the batch path (read ahead, filter, write behind, chunk threads) of a program built with SANITIZE=thread. Fails on
# any report; the driver's own noise is suppressed (mesa.supp), frames of ours never are.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
mkdir "$dir/in" "$dir/out"
for i in 1 2 3 4 5; do oiiotool samples/still.exr --cut "96x72+$((80 * i))+120" --origin +0+0 --fullpixels -o "$dir/in/f.000$i.exr" || exit 1; done
for i in 1 2 3; do oiiotool "$dir/in/f.000$i.exr" --compression dwaa -o "$dir/in/d.000$i.exr" || exit 1; done
head -c 30000 "$dir/in/f.0003.exr" >"$dir/in/b.0003.exr"
for i in 1 2 4; do cp "$dir/in/f.000$i.exr" "$dir/in/b.000$i.exr"; done
TSAN_OPTIONS="suppressions=$(dirname "$0")/mesa.supp exitcode=66 history_size=4"
export TSAN_OPTIONS
runs=0
# batch NAME CODE FRAMES ARGS...: a sequence with nothing to report, that exit code and so many frames.
batch() {
    name=$1 want=$2 frames=$3
    shift 3
    "$1/ssdo-filter" "$dir/in/$2.####.exr" -o "$dir/out/$2.####.exr" --samples 8 --threads 4 $4 >"$dir/log" 2>&1
    code=$?
    reports=$(grep -c 'WARNING: ThreadSanitizer' "$dir/log")
    written=$(ls "$dir/out" | grep -c '\.exr$')
    [ $code = "$want" ] && [ "$reports" = 0 ] && [ "$written" = "$frames" ] ||
        { cat "$dir/log"; echo "FAILED: $name: exit $code, $reports reports, $written frames"; exit 1; }
    runs=$((runs + 1))
    [ "${3-}" = keep ] || rm -f "$dir"/out/*
}
sky="--env samples/sky_soft.exr"
for transfer in direct mapped; do # as on a software renderer and as on hardware
    SSDO_TRANSFER=$transfer
    export SSDO_TRANSFER
    batch "layers $transfer" 0 5 "$1" f "" "$sky"
done
unset SSDO_TRANSFER
batch "previews and reports" 0 5 "$1" f keep "$sky --preview $dir/out/p.####.png --report $dir/out/r.####.json --progress openjd"
rm -f "$dir/out/f.0002.exr" "$dir/out/f.0004.exr"
batch skips 0 5 "$1" f "" "$sky --preview $dir/out/p.####.png --report $dir/out/r.####.json --skip-existing"
batch "one report" 0 5 "$1" f "" "--report $dir/out/shot.json"
batch "--error" 0 5 "$1" f "" "--error 0.05 --samples 64 --layers occlusion,error"
batch s3ho 0 5 "$1" f "" "--method s3ho --layers occlusion,sh_0,sh_1,sh_2"
batch "vpl, multipart" 0 5 "$1" f "" "--bounce vpl --layout multipart"
batch half 0 5 "$1" f "" "--resolution half"
batch DWA 0 3 "$1" d "" "$sky --layers occlusion"
batch "a broken frame" 1 3 "$1" b "" "--keep-going --report $dir/out/r.####.json"
echo "figure: thread sanitizer: $runs sequences (previews, reports, skips, --error, s3ho, vpl, multipart, half, DWA, a broken frame; layers copied and mapped), 4 threads: 0 reports"
