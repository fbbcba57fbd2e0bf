#!/bin/sh
# check.sh BUILD: a sequence by one command, as a Slurm array with a task killed midway, through the Open Job Description template,
# and by GNU parallel: the same bytes each way. The frames are rendered by Blender once and kept in BUILD/farm/in.
set -u
build=$(cd "$1" && pwd)
root=$(pwd)
work=$build/farm
frames=12
SSDO=$build/ssdo-filter
export SSDO
. tests/farm/slurm.sh
temp=$(mktemp -d /tmp/ssdo-farm.XXXXXX)
trap 'slurm_stop; rm -rf "$temp"' EXIT
trap 'exit 130' INT TERM
die() { echo "FAILED: $*" >&2; tail -n 5 "$temp"/slurm/*.log 2>/dev/null >&2; exit 1; }

# same FOLDER: all frames are there and equal to the single command's, and nothing else is.
same() {
    for i in $(seq -w $frames); do cmp "$work/single/lit.00$i.exr" "$1/lit.00$i.exr" || die "frame $i of $1 differs"; done
    [ "$(ls -A "$1" | grep -vc '\.log$')" = $frames ] || die "$1 holds other files: $(ls -A "$1")"
}

if [ "$(cat "$work/in/complete" 2>/dev/null)" != "$(cksum <tests/farm/render.py)" ]; then
    echo "rendering $frames frames"
    rm -rf "$work/in" && mkdir -p "$work/in"
    blender -b --factory-startup -P tests/farm/render.py -- --out "$work/in" --frames $frames >"$work/render.log" 2>&1 &&
        [ "$(ls "$work/in" | wc -l)" = $frames ] || die "Blender did not render; see $work/render.log"
    cksum <tests/farm/render.py >"$work/in/complete"
fi
options="--samples ${FARM_SAMPLES:-512}"
for how in single slurm openjd parallel; do rm -rf "${work:?}/$how" && mkdir "$work/$how"; done

"$SSDO" -q "$work/in/shot.####.exr" -o "$work/single/lit.####.exr" $options || die "the single command"
[ "$(cat "$work"/single/*.exr | cksum)" != "$(cat "$work/single/lit.0001.exr" | cksum)" ] || die "the frames are all the same"
cmp -s "$work/single/lit.0001.exr" "$work/single/lit.0002.exr" && die "the camera does not move"
echo "ok      one command: $frames frames"

# Slurm: two tasks of six frames. The second is cancelled when it has written its first.
slurm_start "$temp/slurm" || die "Slurm does not start: $(cat "$temp/slurm/munge/err")"
cd "$work/slurm" || exit 1
submit() { sbatch --parsable --cpus-per-task=1 --array=1-$frames:6 "$root/samples/farm/slurm.sh" "$work/in/shot.####.exr" 'lit.####.exr' $options; }
finished() {
    for i in $(seq 1200); do
        [ -z "$(squeue -h -t PENDING,RUNNING,COMPLETING)" ] && return 0
        sleep 0.25
    done
    die "the array did not end: $(squeue)"
}
job=$(submit) || die "sbatch"
for i in $(seq 1200); do [ -e lit.0007.exr ] && break; sleep 0.05; done
[ -e lit.0007.exr ] || die "the second task wrote nothing: $(cat ./*.log)"
scancel "${job}_7" || die "scancel"
finished
state=$(scontrol -o show job "${job}_7" | sed -n 's/.*JobState=\([A-Z]*\).*/\1/p')
[ "$state" = CANCELLED ] || die "the cancelled task is $state"
[ -e lit.0012.exr ] && die "the second task was not interrupted; give FARM_SAMPLES a larger number"
grep -q 'ssdo-filter: warning: stopped:' "ssdo-filter.${job}_7.log" || die "the program was not told to stop: $(cat "ssdo-filter.${job}_7.log")"
[ -z "$(find . -name '*.tmp')" ] || die "temporary files are left"
left=$(ls lit.*.exr | wc -l)
job=$(submit) || die "sbatch"
finished
[ "$(cat ssdo-filter."${job}"_*.log | grep -c 'skipped, already done')" = "$left" ] || die "done frames were made again: $(cat ./ssdo-filter."${job}"_*.log)"
cd "$root" || exit 1
same "$work/slurm"
echo "ok      Slurm array: cancelled with $left of $frames frames, completed by the same line, the same bytes"

# The README's farm commands as they stand, in a folder that looks like a clone.
sh tests/readme.sh slurm >"$temp/slurm.commands" && sh tests/readme.sh openjd.py >"$temp/openjd.commands"
mkdir "$temp/clone" "$temp/bin" && ln -s "$root/samples" "$root/tests" "$temp/clone" && ln -s "$SSDO" "$temp/bin"
PATH=$temp/bin:$PATH
cd "$temp/clone" || exit 1
sh samples/shot.sh try && ssdo-filter -q 'try/shot.####.exr' -o 'try/lit.####.exr' --env samples/sky_soft.exr || die "samples/shot.sh"
sh -e "$temp/slurm.commands" >"$temp/log" 2>&1 || die "$(cat "$temp/slurm.commands"): $(cat "$temp/log")"
finished
for i in $(seq -w $frames); do cmp try/lit.00$i.exr try/slurm.00$i.exr || die "the README's sbatch line makes another frame $i: $(tail -n 3 ssdo-filter.*.log)"; done
slurm_stop
sh -e "$temp/openjd.commands" >"$temp/log" 2>&1 || die "$(cat "$temp/openjd.commands"): $(cat "$temp/log")"
[ "$(ls try | grep -c '^jd\.00.*exr$')" = $frames ] && grep -qx "$(sed -n 's/^#=> //p' "$temp/openjd.commands")" "$temp/log" || die "the README's openjd.py line prints: $(cat "$temp/log")"
cd "$root" || exit 1
echo "ok      README: its farm commands, as typed"

# Open Job Description, by openjd-cli where it is installed. A copy of the template takes the option, as its comment says.
awk -v o="$options" '{ print } /"openjd"$/ { n = split(o, w, " "); for (i = 1; i <= n; i++) print "            - \"" w[i] "\"" }' \
    samples/farm/openjd.yaml >"$temp/openjd.yaml"
set -- -p InputFolder="$work/in" -p OutputFolder="$work/openjd" -p Frames=1-$frames -p FramesPerTask=5 -p Program="$SSDO"
python3 tests/farm/openjd.py "$temp/openjd.yaml" "$@" 2>"$temp/err" || die "openjd.py: $(cat "$temp/err")"
same "$work/openjd"
if command -v openjd >/dev/null 2>&1; then
    rm "$work"/openjd/*
    openjd run "$temp/openjd.yaml" --step Filter "$@" >"$temp/log" 2>&1 || die "openjd-cli: $(tail -20 "$temp/log")"
    same "$work/openjd"
    echo "ok      openjd-cli: the same bytes"
fi
echo "ok      Open Job Description template: the same bytes"

# GNU parallel, as the README shows it.
seq $frames | parallel -j2 "$SSDO" -q "$work/in/shot.####.exr" -o "$work/parallel/lit.####.exr" --frames {} $options || die parallel
same "$work/parallel"
echo "ok      GNU parallel: the same bytes"
