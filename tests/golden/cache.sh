#!/bin/sh
# A cache folder that is full, read-only, another's, vanished or no folder costs a compile and nothing else; 8 processes share one
# cache and one output.
set -u
dir=$(mktemp -d)
trap 'umount "$dir/small" 2>/dev/null; rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; [ -s "$dir/err" ] && cat "$dir/err"; exit 1; }
unset MESA_SHADER_CACHE_DIR MESA_SHADER_CACHE_DISABLE
oiiotool samples/still.exr --cut 40x32+200+120 --origin +0+0 --fullpixels -o "$dir/in.exr" || die oiiotool
export XDG_CACHE_HOME="$dir/cache"
run() { "$SSDO" -q "$dir/in.exr" -o "$dir/${2-out}.exr" --samples 4 2>"$dir/err" || die "$1: exit code $?"; }
same() { run "$1"; cmp "$dir/out.exr" "$dir/good.exr" || die "$1: other bytes"; tried=$((tried + 1)); }
tried=0
run clean good
[ "$(stat -c %a "$dir/cache/ssdo-filter")" = 700 ] || die "the folder's rights"
same warm
chmod 777 "$dir/cache/ssdo-filter" && same 'a folder that all may write into'
rm -rf "$dir/cache/ssdo-filter" && touch "$dir/cache/ssdo-filter" && same 'a file as folder'
rm -rf "$dir/cache" && ln -s /proc/nowhere "$dir/cache" && same 'a broken link'
rm "$dir/cache" && mkdir "$dir/small"
if mount -t tmpfs -o size=512k none "$dir/small" 2>/dev/null; then
    XDG_CACHE_HOME=$dir/small
    for room in 16 64 512 2048 8192; do
        rm -rf "$dir/small/ssdo-filter" && mount -o remount,size=${room}k "$dir/small" && same "a disk of $room kB"
    done
    dd if=/dev/zero of="$dir/small/ballast" bs=1k 2>/dev/null
    same 'a full disk'
    mount -o remount,ro "$dir/small" && same 'a read-only disk'
fi
XDG_CACHE_HOME=$dir/cache
pids=
for i in 1 2 3 4 5 6 7 8; do "$SSDO" -q "$dir/in.exr" -o "$dir/out.exr" --samples 4 & pids="$pids $!"; done
for p in $pids; do wait "$p" || die "one of 8 processes: exit code $?"; done
cmp "$dir/out.exr" "$dir/good.exr" || die "8 processes on one output"
[ -z "$(find "$dir" -maxdepth 1 -name '.*tmp')" ] || die "8 processes leave something"
same 'after 8 processes'
echo "figure: $tried states of the cache folder, the same bytes each time; 8 processes on one cache and one output"
