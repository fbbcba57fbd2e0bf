#!/bin/sh
# --proxies on a sequence: with a place for the frame in its name every frame has its own spheres, whatever the task's share; without
# one all frames have the same; a file that is missing is that frame's failure.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; exit 1; }
run() { "$SSDO" -q --keep none --samples 8 --layers occlusion --radius 1.5 "$@"; }
mkdir "$dir/own" "$dir/one" "$dir/task"
for i in 1 2 3; do
    cp samples/proxies/beside.exr "$dir/in.000$i.exr"
    # The crate falls by 0.3 a frame.
    awk -v fall="$i" '/centre/ { split($0, v, /, |\]/); sub(v[3] "\\]", v[3] - 0.3 * fall "]") } { print }' samples/proxies/beside.json >"$dir/balls.000$i.json"
done
cmp -s "$dir/balls.0001.json" "$dir/balls.0003.json" && die "the spheres do not move"

run "$dir/in.####.exr" -o "$dir/own/f.####.exr" --proxies "$dir/balls.####.json" || die "the sequence"
for i in 1 2 3; do
    run "$dir/in.000$i.exr" -o "$dir/frame.exr" --proxies "$dir/balls.000$i.json" || die "frame $i"
    oiiotool "$dir/frame.exr" "$dir/own/f.000$i.exr" --fail 0 --diff >"$dir/log" || die "frame $i is not what its own file makes: $(cat "$dir/log")"
done
for pair in '1 2' '2 3'; do
    oiiotool "$dir/own/f.000${pair% *}.exr" "$dir/own/f.000${pair#* }.exr" --fail 0.01 --diff >/dev/null && die "frames $pair have the same spheres"
done

# A task with frame 3 only; printf's kind of place.
run "$dir/in.####.exr" -o "$dir/task/f.####.exr" --frames 3 --proxies "$dir/balls.%04d.json" || die "the task"
oiiotool "$dir/task/f.0003.exr" "$dir/own/f.0003.exr" --fail 0 --diff >"$dir/log" || die "a task of one frame differs: $(cat "$dir/log")"

run "$dir/in.####.exr" -o "$dir/one/f.####.exr" --proxies "$dir/balls.0002.json" || die "one file for all"
for i in 1 2 3; do oiiotool "$dir/one/f.000$i.exr" "$dir/own/f.0002.exr" --fail 0 --diff >"$dir/log" || die "frame $i: $(cat "$dir/log")"; done

rm "$dir/balls.0002.json" "$dir"/own/*
run "$dir/in.####.exr" -o "$dir/own/f.####.exr" --proxies "$dir/balls.####.json" --keep-going 2>"$dir/err"
[ $? = 1 ] || die "exit code with a file missing"
grep -q 'balls.0002.json' "$dir/err" && grep -q 'failed: 2' "$dir/err" || die "the missing file is not named: $(cat "$dir/err")"
[ "$(cd "$dir/own" && echo *)" = 'f.0001.exr f.0003.exr' ] || die "the other frames: $(ls "$dir/own")"
