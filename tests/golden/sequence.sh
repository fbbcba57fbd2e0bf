#!/bin/sh
# Sequences: one command equals single frames with the same radius; an interrupted run completes with --skip-existing to the same
# bytes; failing frames are listed and cost nobody else.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; exit 1; }
mkdir "$dir/in" "$dir/a" "$dir/b" "$dir/c"
for i in 1 2 3 4 5 6; do oiiotool samples/still.exr --cut "$((150 + 10 * i))x120+20+30" --origin +0+0 --fullpixels -o "$dir/in/f.000$i.exr" || die oiiotool; done
"$SSDO" -q "$dir/in/f.####.exr" -o "$dir/a/f.####.exr" || die "the sequence"
[ "$(ls "$dir/a" | wc -l)" = 6 ] || die "not all frames were written"

# A task of a farm sees other frames but finds the same radius: same bytes.
for i in 5 2; do "$SSDO" -q "$dir/in/f.%04d.exr" -o "$dir/b/f.%04d.exr" --frames $i || die "frame $i"; cmp "$dir/a/f.000$i.exr" "$dir/b/f.000$i.exr" || die "frame $i differs"; done

# Interrupted at once, then completed.
"$SSDO" -q "$dir/in/f.####.exr" -o "$dir/c/f.####.exr" &
pid=$!
sleep 0.7
kill -TERM $pid
wait $pid
code=$?
[ $code = 143 ] || [ $code = 0 ] || die "SIGTERM gave exit code $code"
[ -z "$(find "$dir/c" -name '*tmp*')" ] || die "a temporary file is left"
before=$(ls "$dir/c" | wc -l)
"$SSDO" -q "$dir/in/f.####.exr" -o "$dir/c/f.####.exr" --skip-existing || die "completing"
for i in 1 2 3 4 5 6; do cmp "$dir/a/f.000$i.exr" "$dir/c/f.000$i.exr" || die "frame $i differs after resuming"; done

# A frame from another device counts as done, with a warning; so does one that another task has made.
device=$(exrheader "$dir/a/f.0002.exr" | sed -n 's/^ssdo.device .*: "\(.*\)"$/\1/p')
other=$(echo "$device" | sed 's/./X/g') # of the same length, so that the file stays sound
[ -n "$device" ] && LC_ALL=C sed "s|$device|$other|" "$dir/a/f.0002.exr" >"$dir/c/f.0002.exr" || die "no ssdo/device in the header"
"$SSDO" "$dir/in/f.####.exr" -o "$dir/c/f.####.exr" --skip-existing --frames 1-3 >"$dir/log" 2>&1 || die "another device"
[ "$(grep -c 'skipped, already done' "$dir/log")" = 3 ] || die "a frame of another device was made again: $(cat "$dir/log")"
[ "$(grep -c "made on '$other'" "$dir/log")" = 1 ] || die "no warning of another device: $(cat "$dir/log")"
rm "$dir/c/f.0001.exr"
"$SSDO" "$dir/in/f.####.exr" -o "$dir/c/f.####.exr" --frames 1 2>&1 | grep -q "made on '$other'" || die "no warning of a neighbour's device"
cp "$dir/a/f.0002.exr" "$dir/c/f.0002.exr"
"$SSDO" "$dir/in/f.####.exr" -o "$dir/c/f.####.exr" --frames 1 2>&1 | grep -q "made on" && die "a warning of the same device"

# Other settings are not 'already done'; a damaged output is done again.
"$SSDO" "$dir/in/f.####.exr" -o "$dir/c/f.####.exr" --skip-existing --frames 1-2 --samples 8 2>&1 | grep -q skipped && die "other settings were taken for the same"
"$SSDO" -q "$dir/in/f.####.exr" -o "$dir/c/f.####.exr" --frames 1-2 || die "redoing"
head -c 30000 "$dir/a/f.0001.exr" >"$dir/c/f.0001.exr"
"$SSDO" -q "$dir/in/f.####.exr" -o "$dir/c/f.####.exr" --skip-existing || die "repairing"
cmp "$dir/a/f.0001.exr" "$dir/c/f.0001.exr" || die "a truncated output was kept"

# A bad frame among good ones.
head -c 20000 "$dir/in/f.0003.exr" >"$dir/in/bad" && mv "$dir/in/bad" "$dir/in/f.0003.exr"
rm -rf "$dir/b" && mkdir "$dir/b"
"$SSDO" -q "$dir/in/f.####.exr" -o "$dir/b/f.####.exr" --frames 1-7 --keep-going 2>"$dir/err"
[ $? = 1 ] || die "exit code of a batch with bad frames"
grep -q 'failed: 3, 7' "$dir/err" || die "the list of failed frames: $(cat "$dir/err")"
[ "$(ls "$dir/b" | wc -l)" = 5 ] || die "good frames are missing"
echo "figure: interrupted after $before of 6 frames, resumed to the same bytes"
