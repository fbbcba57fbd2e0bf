#!/bin/sh
# The fault table: each system call that the program makes while it reads, renders and writes fails once at each of its occurrences
# (fault.c), in a single frame and in a sequence with previews and reports. After every run: the documented exit code and a sentence,
# never a hang or a crash, under every target's name the older file or the whole new one, the inputs as they were; and the next run
# completes. SSDO_HARD=whole tries every occurrence, else the first, the middle one and the last of each call. With SSDO_TABLES the
# table goes there.
set -u
build=$(dirname "$SSDO")
fault=$build/tests/fault.so
[ -e "$fault" ] || { echo "no $fault"; exit 77; }
case $(nm -D "$SSDO" 2>/dev/null) in *__asan*|*__tsan*) echo "a sanitizer's own calls are not the program's"; exit 77 ;; esac
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; [ -s "$dir/err" ] && cat "$dir/err"; exit 1; }
mkdir "$dir/in" "$dir/good" "$dir/out" "$dir/cache"
XDG_CACHE_HOME=$dir/cache
export XDG_CACHE_HOME
for i in 1 2; do
    oiiotool samples/still.exr --cut 64x48+$((100 * i))+120 --origin +0+0 --fullpixels -o "$dir/in/f.000$i.exr" >/dev/null || die oiiotool
done
oiiotool samples/sky_soft.exr --resize 64x32 -o "$dir/in/sky.exr" >/dev/null 2>&1 || die oiiotool
printf '{"spheres": [{"centre": [0, 0, 90], "radius": 0.5}]}' >"$dir/in/spheres.json"
(cd "$dir/in" && sha256sum *) >"$dir/inputs"
common="-q --radius 0.3 --samples 4 --threads 2 --layers occlusion,radiance --env $dir/in/sky.exr --proxies $dir/in/spheres.json"

one() { "$SSDO" $common "$dir/in/f.0001.exr" -o "$1/o.0001.exr" --preview "$1/p.0001.png" --report "$1/r.0001.json"; }
many() { "$SSDO" $common "$dir/in/f.####.exr" -o "$1/o.####.exr" --preview "$1/p.####.png" --report "$1/r.####.json" --keep-going $2; }
run() { # single|sequence FOLDER ...
    if [ "$1" = single ]; then one "$2"; else many "$2" "${3-}"; fi
}
many "$dir/good" "" 2>"$dir/err" || die "the clean run"

# Pixels and attributes; reports hold times, so of those only that they are whole.
same() { cmp -s "$1" "$2"; }
whole() { # FOLDER WHAT: every file there is the older one or whole
    for f in "$1"/*; do
        [ -e "$f" ] || continue
        name=$(basename "$f")
        [ "$(head -c 3 "$f")" = old ] && continue
        case $name in
        *.json) [ "$(tail -c 2 "$f")" = "}" ] || die "$2: a partial $name" ;;
        *) same "$f" "$dir/good/$name" || die "$2: a partial or different $name" ;;
        esac
    done
}
# The exit codes that a kind's fault may have besides 0, for a frame; a sequence says 1 where frames failed.
codes() {
    case $1 in
    open) echo "2 3 4 5" ;;
    read) echo "2 3" ;;
    stat) echo "2 3 4" ;;
    write|fsync|rename|close|allocate|folder) echo "3 4" ;;
    mmap|thread) echo "5 6" ;;
    egl) echo "5" ;;
    *) echo none ;;
    esac
}

tried=0 mattered=0 rows=
# try KIND single|sequence N
try() {
    what="$1 $3 of a $2"
    rm -rf "$dir/out" && mkdir "$dir/out"
    frames=1
    [ "$2" = sequence ] && frames="1 2"
    for i in $frames; do for f in o.000$i.exr p.000$i.png r.000$i.json; do echo old >"$dir/out/$f"; done; done
    [ "$1" = mkdir ] && rm -rf "$dir/cache" && mkdir "$dir/cache"
    SSDO_FAULT=$1 SSDO_FAULT_AT=$3 LD_PRELOAD=$fault timeout -k 1 60 "$SSDO" $common $(arguments "$2") >/dev/null 2>"$dir/err"
    code=$?
    whole "$dir/out" "$what"
    (cd "$dir/in" && sha256sum -c --quiet "$dir/inputs" >/dev/null 2>&1) || die "$what: an input changed"
    tried=$((tried + 1))
    if [ $code != 0 ]; then
        mattered=$((mattered + 1))
        case " $(codes "$1") " in *" $code "*) ;; *) [ $code = 1 ] && [ "$2" = sequence ] || die "$what: exit code $code" ;; esac
        grep -q '^ssdo-filter: ' "$dir/err" && ! grep -qv '^ssdo-filter: ' "$dir/err" || die "$what: no sentence"
    else
        for f in "$dir"/out/*; do [ "$(head -c 3 "$f")" != old ] || die "$what: exit code 0, and $(basename "$f") is the older one"; done
    fi
    # The next run.
    if [ $code != 0 ] && { [ "${SSDO_HARD-}" = whole ] || [ "$2" = single ]; }; then
        run "$2" "$dir/out" --skip-existing 2>"$dir/err" || die "$what: the next run"
        for i in $frames; do for f in o.000$i.exr p.000$i.png; do same "$dir/out/$f" "$dir/good/$f" || die "$what: $f after the next run"; done; done
        [ -z "$(find "$dir/out" -name '.*tmp')" ] || die "$what: the next run leaves $(ls -A "$dir/out")"
    fi
}
arguments() {
    if [ "$1" = single ]; then
        echo "$dir/in/f.0001.exr -o $dir/out/o.0001.exr --preview $dir/out/p.0001.png --report $dir/out/r.0001.json"
    else
        echo "$dir/in/f.####.exr -o $dir/out/o.####.exr --preview $dir/out/p.####.png --report $dir/out/r.####.json --keep-going"
    fi
}
# How many there are, with nothing failing.
occurrences() {
    rm -rf "$dir/out" && mkdir "$dir/out"
    [ "$1" = mkdir ] && rm -rf "$dir/cache" && mkdir "$dir/cache"
    SSDO_FAULT=$1 SSDO_FAULT_COUNT=$dir/count LD_PRELOAD=$fault "$SSDO" $common $(arguments "$2") >/dev/null 2>"$dir/err" ||
        die "$1: the run that counts"
    cat "$dir/count"
}

for kind in open read write fsync rename close mmap allocate mkdir unlink folder thread egl; do
    row="| $kind"
    for form in single sequence; do
        n=$(occurrences $kind $form) || { echo "$n"; exit 1; }
        before=$tried failed=$mattered
        if [ "${SSDO_HARD-}" = whole ]; then
            i=1
            while [ $i -le "$n" ]; do try $kind $form $i; i=$((i + 1)); done
        elif [ $form = single ] || [ $kind = open ] || [ $kind = write ] || [ $kind = rename ]; then
            last=0
            for i in 1 $(((n + 1) / 2)) "$n"; do
                [ "$i" -gt $last ] && try $kind $form "$i"
                last=$i
            done
        fi
        row="$row | $n | $((tried - before)) | $((mattered - failed))"
    done
    rows="$rows$row |
"
done
if [ -n "${SSDO_TABLES-}" ]; then
    {
        echo "**System calls that fail**: each call of the program and of the libraries that read and write for it fails once. Calls: what"
        echo "a run makes; stopped: those of the tried that ended with an error; the others did not matter, and the output was the same, byte"
        echo "for byte. No partial target, no lost input, every next run completed."
        echo
        echo "| call | single frame: calls | tried | stopped | sequence of 2: calls | tried | stopped |"
        echo "| --- | --- | --- | --- | --- | --- | --- |"
        printf '%s\n' "$rows" # ends in a line that is empty
    } >"$SSDO_TABLES/table.md"
fi
echo "figure: $tried system calls failed once each, $mattered of them ended the frame: 0 partial targets, 0 lost inputs, every next run completed"
