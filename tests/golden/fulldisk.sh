#!/bin/sh
# A disk that is full when the preview or the report is written: exit code 4, one sentence, the earlier file as it was, nothing left
# behind; with room again, the next run completes. Needs the right to mount a small disk.
set -u
dir=$(mktemp -d)
trap 'umount "$dir/small" 2>/dev/null; rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; [ -s "$dir/err" ] && cat "$dir/err"; exit 1; }
mkdir "$dir/small"
mount -t tmpfs -o size=512k none "$dir/small" 2>/dev/null || { echo "no right to mount"; exit 77; }
oiiotool samples/still.exr --cut 96x72+200+120 --origin +0+0 --fullpixels -o "$dir/in.exr" >/dev/null || die oiiotool
run() { "$SSDO" -q "$dir/in.exr" --samples 8 -o "$dir/out.exr" "$@" 2>"$dir/err" >/dev/null; code=$?; }

tried=0
for kind in preview.png report.json; do
    target=$dir/small/$kind option=--${kind%.*}
    mount -o remount,size=512k "$dir/small"
    run "$option" "$target"
    [ $code = 0 ] || die "the clean run"
    cp "$target" "$dir/good"
    pages=$((($(stat -c %s "$target") + 4095) / 4096))
    room=0
    while [ $room -lt $pages ]; do # pages left
        mount -o remount,size=$((4 * (pages + room)))k "$dir/small" || die remount
        run "$option" "$target"
        [ $code = 4 ] || die "$kind with $room of $pages pages free: exit code $code"
        [ "$(wc -l <"$dir/err")" = 1 ] && grep -q "$kind.*No space left" "$dir/err" || die "$kind with $room pages free: the sentence"
        cmp "$target" "$dir/good" || die "$kind with $room of $pages pages free: the earlier file is gone"
        [ "$(ls -A "$dir/small")" = "$kind" ] || die "left behind: $(ls -A "$dir/small")"
        room=$((room + 1 + pages / 12)) tried=$((tried + 1))
    done
    mount -o remount,size=512k "$dir/small"
    run "$option" "$target"
    [ $code = 0 ] || die "the run after the full disk"
    rm "$target"
    run "$option" /dev/full
    [ $code = 4 ] || die "/dev/full as $option: exit code $code"
    [ -c /dev/full ] || die "/dev/full was replaced"
done
echo "figure: $tried times no room for a preview or report: 0 of them lost"
