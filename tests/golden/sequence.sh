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
until [ -e "$dir/c/f.0002.exr" ] || ! kill -0 $pid 2>/dev/null; do sleep 0.05; done
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

# An input that was rendered again is filtered again; a single frame knows --skip-existing and --missing, too.
oiiotool "$dir/in/f.0002.exr" --mulc 1.0625 -o "$dir/in/f.0002.exr" || die oiiotool
"$SSDO" "$dir/in/f.####.exr" -o "$dir/c/f.####.exr" --skip-existing --frames 1-2 >"$dir/log" 2>/dev/null || die "a newer input"
[ "$(grep skipped "$dir/log")" = "frame 1 (1 of 2): skipped, already done" ] || die "a newer input: $(cat "$dir/log")"
"$SSDO" -q "$dir/in/f.0001.exr" -o "$dir/one.exr" --samples 4 || die "one frame"
[ "$("$SSDO" "$dir/in/f.0001.exr" -o "$dir/one.exr" --samples 4 --skip-existing)" = "$dir/one.exr: skipped, already done" ] || die "one frame was made again"
[ -z "$("$SSDO" "$dir/in/f.0001.exr" -o "$dir/one.exr" --samples 8 --skip-existing 2>/dev/null)" ] || die "one frame with other settings was left out"
[ "$("$SSDO" "$dir/in/f.9999.exr" -o "$dir/two.exr" --missing skip)" = "$dir/two.exr: skipped, the input is missing" ] || die "--missing skip of one frame"

# A bad frame among good ones.
head -c 20000 "$dir/in/f.0003.exr" >"$dir/in/bad" && mv "$dir/in/bad" "$dir/in/f.0003.exr"
rm -rf "$dir/b" && mkdir "$dir/b"
"$SSDO" -q "$dir/in/f.####.exr" -o "$dir/b/f.####.exr" --frames 1-7 --keep-going 2>"$dir/err"
[ $? = 1 ] || die "exit code of a batch with bad frames"
grep -q 'failed: 3, 7' "$dir/err" || die "the list of failed frames: $(cat "$dir/err")"
[ "$(ls "$dir/b" | wc -l)" = 5 ] || die "good frames are missing"

# One report about all frames; previews at the chosen step, the same frames whatever the task's share.
"$SSDO" -q "$dir/in/f.####.exr" -o "$dir/b/f.####.exr" --frames 1-6 --keep-going --skip-existing --report "$dir/shot.json" 2>/dev/null
for line in '"done": 0' '"skipped": 5' '"failed": 1' '"failed_frames": "3"' '"status": "failed"' '"why": "already done"'; do
    grep -qF "$line" "$dir/shot.json" || die "the report lacks $line: $(cat "$dir/shot.json")"
done
rm "$dir"/b/*
"$SSDO" -q "$dir/in/f.####.exr" -o "$dir/b/f.####.exr" --frames 1-2,4-6 --samples 4 --preview "$dir/b/p.####.png" --preview-every 2 --report "$dir/b/r.####.json" || die "previews"
[ "$(cd "$dir/b" && echo p.*)" = "p.0002.png p.0004.png p.0006.png" ] || die "previews: $(ls "$dir/b")"
[ "$(ls "$dir/b" | grep -c '^r\.000[12456]\.json$')" = 5 ] || die "reports: $(ls "$dir/b")"
"$SSDO" -q "$dir/in/f.####.exr" -o "$dir/b/f.####.exr" --preview "$dir/b/p.png" 2>&1 | grep -q "a place for the frame in the preview's name" || die "a preview that is overwritten"

# The contact sheet: two columns of cells, a legend below, a checkerboard of two greys where the picture has no surface.
"$SSDO" -q samples/still.exr -o "$dir/x.exr" --samples 4 --preview "$dir/x.png" || die "the preview"
oiiotool --info "$dir/x.png" | grep -q '978 x  678, 3 channel' || die "the size of the sheet: $(oiiotool --info "$dir/x.png")"
grey() { oiiotool "$dir/x.png" --cut "8x8+$1+$2" -o "$dir/x.ppm" && tail -c 192 "$dir/x.ppm" | od -An -v -tu1 -w3 | sed 's/^ *//; s/  */ /g' | sort -u | tr '\n' ','; }
for at in '8 32' '494 32' '8 332' '494 332'; do
    case $(grey $at) in *"72 72 72"*) ;; *) die "no checkerboard at $at: $(grey $at)" ;; esac
done
"$SSDO" -q samples/horizon.exr -o "$dir/x.exr" --samples 4 --preview "$dir/x.png" --layers composite || die "the preview"
case $(grey 8 32) in *"72 72 72"* | *"104 104 104"*) die "a sky is not 'no surface': $(grey 8 32)" ;; esac
echo "figure: interrupted after $before of 6 frames, resumed to the same bytes"
