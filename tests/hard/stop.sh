#!/bin/sh
# SIGTERM at moments spread over a whole 4K frame (read, resolve, each pass, read-back, write, preview), also at half resolution and
# with --error, and in a sequence: the process ends within a second with 143 and leaves nothing behind; a last run completes.
# SSDO_HARD=whole tries 8 moments of each kind, of 3840 x 2160 pixels; else 2, of 480 x 270.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; [ -s "$dir/err" ] && cat "$dir/err"; exit 1; }
moments=2 size=480x270
[ "${SSDO_HARD-}" = whole ] && moments=8 size=3840x2160
oiiotool samples/still.exr --resize:filter=box $size -o "$dir/in.0001.exr" >/dev/null 2>&1 || die oiiotool
cp "$dir/in.0001.exr" "$dir/in.0002.exr"
now() { date +%s%N; }
worst=0 stopped=0 slow=0

# stop KIND OUTPUT ARGS...: one whole run for its length, then one stopped at each moment.
stop() {
    kind=$1 out=$2
    shift 2
    start=$(now)
    "$SSDO" -q "$@" -o "$dir/out/$out" 2>"$dir/err" || die "$kind: the whole run"
    span=$((($(now) - start) / 1000000))
    k=0
    while [ $k -lt $moments ]; do
        wait_ms=$((span * (2 * k + 1) / (2 * moments)))
        k=$((k + 1))
        for try in 1 2 3; do # a machine that is busy with other things takes its time to free a process
            stop_at "$out" "$@"
            [ $took -le 1000 ] && break
            echo "$kind: took $took ms at $wait_ms of $span ms"
        done
        [ $code = 0 ] && continue # it was done before
        stopped=$((stopped + 1))
        [ $took -gt $worst ] && worst=$took
        [ $took -gt 1000 ] && slow=$((slow + 1))
    done
}
# One run that is stopped after wait_ms: its exit code and how long its end took.
stop_at() {
    out=$1
    shift
    rm -f "$dir"/out/*
    "$SSDO" -q "$@" -o "$dir/out/$out" 2>"$dir/err" &
    pid=$!
    sleep "$(printf '%d.%03d' $((wait_ms / 1000)) $((wait_ms % 1000)))"
    start=$(now)
    kill -TERM $pid 2>/dev/null
    wait $pid
    code=$?
    took=$((($(now) - start) / 1000000))
    [ $code = 0 ] || [ $code = 143 ] || die "$kind: exit code $code at $wait_ms of $span ms"
    [ -z "$(find "$dir/out" -name '.*tmp')" ] || die "$kind: left $(ls -A "$dir/out") at $wait_ms of $span ms"
    for f in "$dir"/out/*.exr; do
        [ ! -e "$f" ] || oiiotool --stats "$f" >/dev/null 2>&1 || die "$kind: a partial file at $wait_ms of $span ms"
    done
}
mkdir "$dir/out"
stop frame o.exr "$dir/in.0001.exr" --samples 16 --preview "$dir/out/p.png" --report "$dir/out/r.json" --env samples/sky_soft.exr
stop half o.exr "$dir/in.0001.exr" --resolution half
stop error o.exr "$dir/in.0001.exr" --error 0.02 --samples 256
stop sequence o.####.exr "$dir/in.####.exr" --samples 16 --preview "$dir/out/p.####.png"
"$SSDO" -q "$dir/in.####.exr" --samples 16 --skip-existing -o "$dir/out/o.####.exr" 2>"$dir/err" || die "the run after the stops"
[ -e "$dir/out/o.0001.exr" ] && [ -e "$dir/out/o.0002.exr" ] || die "the run after the stops leaves frames out"
[ $slow = 0 ] || die "$slow of $stopped stops took longer than a second three times in a row"
echo "figure: SIGTERM at $stopped moments of frames of $size: the slowest end took $worst ms, nothing was left"
