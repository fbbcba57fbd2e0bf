#!/bin/sh
# A cache folder that is full, read-only, another's, vanished or no folder costs a compile and nothing else, and so do entries that
# were exchanged, or are pipes, devices, links, folders or another user's; 8 processes share one cache and one output.
set -u
dir=$(mktemp -d)
trap 'umount "$dir/small" 2>/dev/null; rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; [ -s "$dir/err" ] && cat "$dir/err"; exit 1; }
unset MESA_SHADER_CACHE_DIR MESA_SHADER_CACHE_DISABLE
oiiotool samples/still.exr --cut 40x32+200+120 --origin +0+0 --fullpixels -o "$dir/in.exr" || die oiiotool
export XDG_CACHE_HOME="$dir/cache"
run() { timeout 300 "$SSDO" -q "$dir/in.exr" -o "$dir/${2-out}.exr" --samples 4 2>"$dir/err" || die "$1: exit code $?"; }
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

# The entries of a kind, each with the content of the K-th after it.
rotate() { # K LIST
    count=$(wc -l <"$2")
    [ "$count" -gt "$1" ] || die "$2 lists $count entries"
    i=0
    while read -r f; do i=$((i + 1)) && cp "$f" "$dir/entry.$i"; done <"$2"
    i=0
    while read -r f; do i=$((i + 1)) && cp "$dir/entry.$(((i - 1 + $1) % count + 1))" "$f"; done <"$2"
}
entries() { # the programs, and what Mesa keeps
    find "$dir/cache/ssdo-filter" -name '*.program' | sort >"$dir/programs"
    find "$dir/cache/ssdo-filter" -type f -path '*/mesa*' ! -name index | sort >"$dir/code"
}
same "cold again"
for k in 1 3; do
    entries
    rotate $k "$dir/programs" && rotate $k "$dir/code" && same "entries exchanged, $k apart"
    entries
    rotate $k "$dir/code" && same "machine code exchanged, $k apart"
done
# In place of an entry stands something else, of each kind in turn.
odd() { # NUMBER FILE
    rm "$2"
    case $(($1 % 7)) in
    0) mkfifo "$2" ;;
    1) mkdir "$2" ;;
    2) ln -s /dev/zero "$2" ;;
    3) ln -s "$dir/nothing" "$2" ;;
    4) : >"$2" ;;
    5) mknod "$2" c 1 5 2>/dev/null || : ;;
    6) echo other >"$2" && { chown 12345 "$2" 2>/dev/null || :; } ;;
    esac
}
entries
i=0
for f in $(cat "$dir/programs" "$dir/code"); do odd $i "$f"; i=$((i + 1)); done
[ $i -ge 14 ] || die "only $i entries"
same 'pipes, folders, links, devices and other users'"'"' files as entries'

# The folders that a run leaves to the next hold nothing, and what somebody puts there is not taken for machine code.
spare() { find "$dir/cache/ssdo-filter" -path '*/spare/mesa_shader_cache' "$@"; }
same warm
[ -n "$(spare)" ] || die "a run leaves no folders"
[ -z "$(find "$(spare)" ! -type d)" ] || die "a run leaves something in its folders"
entries
other=$(tail -1 "$dir/code")
while read -r f; do
    key=$(basename "$f" | cut -c 1-40)
    to=$(spare)/$(echo "$key" | cut -c 1-2)
    mkdir -p "$to" && cp "$other" "$to/$(echo "$key" | cut -c 3-)" || die "no folder for $key"
    other=$f
done <"$dir/code"
same 'files in the folders that the last run left'
rm -rf "$dir"/cache/ssdo-filter/mesa-*/spare && mkdir "$dir/mine" && touch "$dir/mine/file"
ln -s "$dir/mine" "$(echo "$dir"/cache/ssdo-filter/mesa-*)/spare"
same 'a link in place of those folders'
[ "$(ls "$dir/mine")" = file ] || die 'what the link points to is another'

# Nothing is left of processes that were killed, and a folder that goes away under one is nothing to it.
"$SSDO" -q "$dir/in.exr" -o "$dir/killed.exr" --samples 4096 &
pid=$!
for i in 1 2 3 4 5 6 7 8 9 10; do [ -n "$(find "$dir/cache" -name 'run-*')" ] && break || sleep 0.2; done
kill -9 $pid && wait $pid 2>/dev/null
same 'after a killed process'
[ -z "$(find "$dir/cache" -name 'run-*')" ] || die "a killed process's folder stays"
run vanishing vanishing &
pid=$!
while kill -0 $pid 2>/dev/null; do rm -rf "$dir/cache"; done
wait $pid || die "a folder that vanishes: exit code $?"
cmp "$dir/vanishing.exr" "$dir/good.exr" || die 'a folder that vanishes: other bytes'
same warm
pids=
for i in 1 2 3 4 5 6 7 8; do "$SSDO" -q "$dir/in.exr" -o "$dir/out.exr" --samples 4 & pids="$pids $!"; done
for p in $pids; do wait "$p" || die "one of 8 processes: exit code $?"; done
cmp "$dir/out.exr" "$dir/good.exr" || die "8 processes on one output"
[ -z "$(find "$dir" -maxdepth 1 -name '.*tmp')$(find "$dir/cache" -name 'run-*')" ] || die "8 processes leave something"
same 'after 8 processes'
echo "figure: $tried states of the cache folder, the same bytes each time; 8 processes on one cache and one output"
