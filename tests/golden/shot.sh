#!/bin/sh
# Frames of the shot as further G-buffers (--surround shot): what has left the frame keeps its shadow; every task and every order gives
# the same bytes; -v says which frames; a changed frame of them makes all frames again. And what it refuses.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; [ -s "$dir/log" ] && cat "$dir/log"; exit 1; }
here=$PWD motion=$(dirname "$SSDO")/tests/bench/motion
cd "$dir" || exit 1

# A curtain leaves the frame. Nothing moves, so occlusion at a point of a surface stays (tests/bench/motion.c).
"$motion" write 240 135 . curtain || die "the shot"
change() { "$motion" score 240 135 . "$1" curtain | cut -f 2; }
look="--radius 0.8 --layers occlusion --keep none --float"
"$SSDO" -q in.#.exr -o alone.#.exr $look || die "without"
"$SSDO" -v in.#.exr -o all.#.exr $look --surround shot --report shot.json >log 2>&1 || die "--surround shot"
grep -q 'surround: frames 1-8 of the shot' log || die "-v does not say which frames"
grep -q '"surround_frames": "1-8"' shot.json || die "the report does not say which frames"
alone=$(change alone) all=$(change all)
echo "figure: change in a shot that a curtain leaves: $alone alone, $all with --surround shot"
awk -v a="$alone" -v b="$all" 'BEGIN { exit !(a > 0.02 && b < 0.014) }' || die "change $alone alone, $all with the shot"

# Another task, another order, another number of threads.
"$SSDO" -q in.#.exr -o task.#.exr $look --surround shot --frames 7,3 --threads 1 || die "a task"
cmp task.3.exr all.3.exr && cmp task.7.exr all.7.exr || die "another task gives other bytes"
cmp -s alone.8.exr all.8.exr && die "--surround shot changes nothing"

# Done is what this very run would make: other frames of the shot decide too.
run() { "$SSDO" in.#.exr -o all.#.exr $look --skip-existing --frames 8 "$@" >log 2>&1 || die "$*"; }
run --surround shot
grep -q 'skipped, already done' log || die "made again"
run
grep -q skipped log && die "another surround is taken for the same"
run --surround shot
cp in.2.exr in.1.exr
run --surround shot
grep -q skipped log && die "a changed frame of the shot is not noticed"

# At most eight, the first and the last among them.
for f in 1 2 3 4; do
    cp in.$f.exr in.1$f.exr
done
"$SSDO" -v in.#.exr -o few.#.exr $look --samples 4 --frames 2 --surround shot 2>&1 | grep -q 'surround: frames 1, 3, 4, 6, 7, 11, 12, 14 of' ||
    die "$("$SSDO" -v in.#.exr -o few.#.exr $look --samples 4 --frames 2 --surround shot 2>&1 | grep surround:)"

# A frame that cannot be read ends the run, or with --keep-going is done without.
head -c 3000 in.14.exr >half && mv half in.14.exr
"$SSDO" -q in.#.exr -o few.#.exr $look --frames 2 --surround shot >log 2>&1 && die "a broken frame of the shot is passed over"
grep -q in.14.exr log || die "the message does not name it"
"$SSDO" in.#.exr -o few.#.exr $look --frames 2 --surround shot --keep-going >log 2>&1 || die "--keep-going"
grep -q 'warning: --surround shot does without frame 14' log || die "no word of the frame that is left out"

"$SSDO" -q in.3.exr -o one.exr $look --surround shot >log 2>&1
[ $? = 2 ] && grep -q -- '--surround shot takes frames of a sequence' log || die "a single frame"
oiiotool in.3.exr --ch Z,N.X,N.Y,N.Z -o flat.1.exr && cp flat.1.exr flat.2.exr
"$SSDO" -q flat.#.exr -o one.#.exr $look --fov 60 --surround shot >log 2>&1
[ $? != 0 ] && grep -q -- '--surround shot is in world space' log || die "a shot without positions"
exit 0
