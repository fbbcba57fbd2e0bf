#!/bin/sh
# Signals and progress, as a farm sees them: SIGTERM drops a frame that would take minutes, at each resolution, SIGINT twice ends at once, and neither
# leaves a file behind; the Open Job Description lines tell the percents and the failure.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; exit 1; }
many="--samples 65536 --layers occlusion --keep none" # minutes on any CPU

# begin OPTION...: the line "pass ..." of -v says that the passes begin.
begin() {
    "$SSDO" -v samples/still.exr -o "$dir/out.exr" $many "$@" 2>"$dir/err" &
    pid=$!
    until grep -q '^ssdo-filter: pass' "$dir/err"; do
        kill -0 $pid 2>/dev/null || die "ended by itself: $(cat "$dir/err")"
        sleep 0.1
    done
    sleep 0.5
}
for how in "--method ssdo" "--method ssdo --resolution half" "--method arc --resolution half" "--method arc --error 1e-6"; do
    begin $how
    since=$(date +%s%N)
    kill -TERM $pid
    wait $pid
    code=$?
    took=$((($(date +%s%N) - since) / 1000000))
    [ $code = 143 ] || die "SIGTERM gave exit code $code with $how: $(cat "$dir/err")"
    echo "figure: SIGTERM ends a frame of minutes ($how) after $took ms"
done
begin --method ssdo
kill -INT $pid
kill -INT $pid
wait $pid
code=$?
[ $code = 130 ] || die "SIGINT twice gave exit code $code"
[ "$(ls -A "$dir")" = err ] || die "files are left: $(ls -A "$dir")"

# Killed outright while it writes, a run leaves its hidden file; the next one on that target removes it, and nothing else that looks
# like one: of a process that lives, of another machine, of another target, of another shape.
dwell=$dir/dwell
mkdir "$dwell"
for i in 1 2 3 4 5 6 7 8; do
    "$SSDO" -q samples/still.exr -o "$dwell/out.exr" --samples 1 --resolution half 2>"$dir/err" &
    pid=$!
    until left=$(ls -A "$dwell" | grep '^\.out\.exr\..*\.tmp$') || ! kill -0 $pid 2>/dev/null; do :; done
    kill -KILL $pid 2>/dev/null
    wait $pid 2>/dev/null
    left=$(ls -A "$dwell" | grep '^\.out\.exr\..*\.tmp$') && break
done
[ -n "$left" ] || die "no run was caught while it wrote"
case $left in .out.exr."$(hostname)-$pid-"*.tmp) ;; *) die "the hidden file does not name its process: $left" ;; esac
rest=${left#.out.exr."$(hostname)-$pid"} # -TAG-RANDOM.tmp
other=$(echo "$rest" | sed 's/^-\(.*\)-/-0123456789abcdef-/')
for name in ".out.exr.$(hostname)-$$$rest" ".out.exr.elsewhere-$pid$rest" ".out.exr.$(hostname)-$pid$other" ".o.exr.$(hostname)-$pid$rest" ".out.exr.$(hostname)-$pid.tmp"; do
    : >"$dwell/$name"
    echo "$name" >>"$dir/kept"
done
echo out.exr >>"$dir/kept"
"$SSDO" -q samples/still.exr -o "$dwell/out.exr" --samples 1 || die "the run after the kill"
[ "$(ls -A "$dwell" | sort)" = "$(sort "$dir/kept")" ] || die "wanted $(sort "$dir/kept"), found $(ls -A "$dwell")"
rm -r "$dwell"

# One good frame, one that is missing.
cp samples/still.exr "$dir/f.0001.exr"
"$SSDO" -q "$dir/f.####.exr" -o "$dir/o.####.exr" --samples 4 --frames 1-2 --keep-going --progress openjd >"$dir/log" 2>/dev/null
code=$?
[ $code = 1 ] || die "exit code $code with a missing frame"
for line in '^openjd_progress: 0$' '^openjd_progress: 100$' '^openjd_status: frame 1 (1 of 2)' '^openjd_fail: 1 of 2 frames failed: 2$'; do
    grep -q "$line" "$dir/log" || die "no line '$line' in: $(cat "$dir/log")"
done
[ "$(grep -vc '^openjd_' "$dir/log")" = 0 ] || die "other lines: $(cat "$dir/log")"
# A usage error is told too, and a single frame has its percents.
"$SSDO" --progress openjd 2>/dev/null | grep -q '^openjd_fail: no input file' || die "no openjd_fail for wrong usage"
"$SSDO" -q "$dir/f.0001.exr" -o "$dir/o.exr" --samples 4 --progress alf | tail -1 | grep -qx 'ALF_PROGRESS 100%' || die "no ALF_PROGRESS"
