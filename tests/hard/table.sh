#!/bin/sh
# The fault table: each system call that the program makes while it reads, renders and writes fails once at each of its occurrences
# (fault.c), in a single frame, in one whose program cache is still empty ("cold"), and in a sequence with automatic radius; all
# with environment, proxies, preview and report. After every run: the documented exit code and a sentence, never a hang or a
# crash, under every target's name the older file or the whole new one, no other result with exit code 0, the inputs as they
# were; and the next run completes. SSDO_HARD=whole tries every occurrence, two processes at a time, else the first, the middle
# one and the last of each call. With SSDO_TABLES the table goes there.
set -u
with=
build=$(dirname "$SSDO")
fault=$build/tests/fault.so
[ -e "$fault" ] || { echo "no $fault"; exit 77; }
case $(nm -D "$SSDO" 2>/dev/null) in *__asan*|*__tsan*) echo "a sanitizer's own calls are not the program's"; exit 77 ;; esac
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; exit 1; }
kinds="open read write fsync rename close mmap allocate mkdir unlink stat folder thread egl"
mkdir "$dir/in"
for i in 1 2; do
    oiiotool samples/still.exr --cut 64x48+$((100 * i))+120 --origin +0+0 --fullpixels -o "$dir/in/f.000$i.exr" >/dev/null || die oiiotool
done
oiiotool samples/sky_soft.exr --resize 64x32 -o "$dir/in/sky.exr" >/dev/null 2>&1 || die oiiotool
printf '{"spheres": [{"centre": [0, 0, 90], "radius": 0.5}]}' >"$dir/in/spheres.json"
(cd "$dir/in" && sha256sum *) >"$dir/inputs"

# program single|cold|sequence FOLDER ARGS...: the whole command, into FOLDER; with the environment `with`.
program() {
    frame='####'
    more=--keep-going
    [ "$1" = sequence ] || frame=0001 more=
    to=$2
    shift 2
    set -- -q "$dir/in/f.$frame.exr" -o "$to/o.$frame.exr" --preview "$to/p.$frame.png" --report "$to/r.$frame.json" --samples 4 \
        --threads 2 --layers occlusion,radiance --env "$dir/in/sky.exr" --proxies "$dir/in/spheres.json" $more "$@"
    timeout -k 1 120 env $with "$SSDO" "$@"
}
frames() { [ "$1" = sequence ] && echo "0001 0002" || echo 0001; }

# try KIND FORM N, in the folder $mine, which holds caches of its own: "KIND FORM N CODE" to its results, or a sentence to `failed`.
failed() {
    { echo "$*"; cat "$mine/err"; } >"$mine/failed"
    exit 1
}
# The exit codes that a kind's fault may have besides 0, for a frame; a sequence says 1 where frames failed.
codes() {
    case $1 in
    open) echo "2 3 4 5" ;;
    read) echo "2 3" ;;
    stat) echo "2 3 4" ;;
    folder) echo 3 ;;
    write|fsync|rename|close|allocate) echo "3 4" ;;
    mmap|thread) echo "5 6" ;;
    egl) echo 5 ;;
    *) echo none ;;
    esac
}
# Reports hold times, so of those only that they are whole.
whole() {
    for f in "$mine"/out/*; do
        [ -e "$f" ] || continue
        [ "$(head -c 3 "$f")" = old ] && continue
        case $f in
        *.json) [ "$(tail -c 2 "$f")" = "}" ] || failed "$what: a partial ${f##*/}" ;;
        *) cmp -s "$f" "$dir/good.$1/${f##*/}" || failed "$what: a partial or different ${f##*/}" ;;
        esac
    done
}
begin() {
    rm -rf "$mine/out" && mkdir "$mine/out"
    XDG_CACHE_HOME=$mine/cache
    [ "$1" = cold ] && XDG_CACHE_HOME=$mine/cold && rm -rf "$mine/cold"
    mkdir -p "$XDG_CACHE_HOME"
    export XDG_CACHE_HOME
}
try() {
    what="$1 $3 of a $2 run"
    begin "$2"
    for i in $(frames "$2"); do for f in o.$i.exr p.$i.png r.$i.json; do echo old >"$mine/out/$f"; done; done
    with="LD_PRELOAD=$fault SSDO_FAULT=$1 SSDO_FAULT_AT=$3"
    program "$2" "$mine/out" >/dev/null 2>"$mine/err"
    code=$? with=
    whole "$2"
    (cd "$dir/in" && sha256sum -c --quiet "$dir/inputs" >/dev/null 2>&1) || failed "$what: an input changed"
    if [ $code = 0 ]; then
        for f in "$mine"/out/*; do [ "$(head -c 3 "$f")" != old ] || failed "$what: exit code 0, and ${f##*/} is the older one"; done
    else
        case " $(codes "$1") " in *" $code "*) ;; *) [ $code = 1 ] && [ "$2" = sequence ] || failed "$what: exit code $code" ;; esac
        grep -q '^ssdo-filter: ' "$mine/err" && ! grep -qv '^ssdo-filter: ' "$mine/err" || failed "$what: no sentence"
        program "$2" "$mine/out" --skip-existing 2>"$mine/err" || failed "$what: the next run"
        for i in $(frames "$2"); do
            for f in o.$i.exr p.$i.png; do cmp -s "$mine/out/$f" "$dir/good.$2/$f" || failed "$what: $f after the next run"; done
        done
        [ -z "$(find "$mine/out" -name '.*tmp')" ] || failed "$what: the next run leaves $(ls -A "$mine/out")"
    fi
    echo "$1 $2 $3 $code" >>"$mine/results"
}

# worker K OF: every OF-th line of the list.
worker() {
    mine=$dir/worker.$1
    mkdir "$mine"
    cp -r "$dir/clean/cold" "$mine/cache"
    : >"$mine/results"
    line=0
    while read -r kind form n; do
        line=$((line + 1))
        [ $((line % $2)) = "$1" ] && try "$kind" "$form" "$n"
    done <"$dir/list"
}

# --- the clean runs, which also count ---
mine=$dir/clean
mkdir "$mine"
for form in cold single sequence; do
    begin $form
    with="LD_PRELOAD=$fault SSDO_FAULT=all SSDO_FAULT_COUNT=$dir/count.$form"
    program $form "$mine/out" 2>"$mine/err" || { cat "$mine/err"; die "the clean run: $form"; }
    with=
    mv "$mine/out" "$dir/good.$form"
    [ $form = cold ] && cp -r "$mine/cold" "$mine/cache" # which the others find filled
done
occurrences() { sed -n "s/^$1 //p" "$dir/count.$2"; }

# What is tried of a kind and form. The writes of a cold run are those of a warm one but for the first, which go to the cache.
for kind in $kinds; do
    for form in single cold sequence; do
        n=$(occurrences $kind $form)
        if [ "${SSDO_HARD-}" = whole ]; then
            [ $kind = write ] && [ $form = cold ] && n=$((n - $(occurrences write single)))
            seq 1 "$n" | sed "s/^/$kind $form /"
        else
            case $form.$kind in
            single.*|cold.mkdir|sequence.open|sequence.stat|sequence.write) ;;
            *) continue ;;
            esac
            for i in 1 $(((n + 1) / 2)) "$n"; do [ "$i" = 0 ] || echo "$kind $form $i"; done | uniq
        fi
    done
done >"$dir/list"

jobs=1
[ "${SSDO_HARD-}" = whole ] && jobs=2
k=1
while [ $k -lt $jobs ]; do
    (worker $k $jobs) &
    k=$((k + 1))
done
(worker 0 $jobs)
wait
cat "$dir"/worker.*/failed 2>/dev/null && die "after $(cat "$dir"/worker.*/results | wc -l) faults"
cat "$dir"/worker.*/results >"$dir/results"
[ "$(wc -l <"$dir/results")" = "$(wc -l <"$dir/list")" ] || die "not all of the list was tried"

tried() { grep -c "^$1 $2 " "$dir/results"; }
stopped() { grep "^$1 $2 " "$dir/results" | grep -vc ' 0$'; }
if [ -n "${SSDO_TABLES-}" ]; then
    {
        echo "**System calls that fail**: each call of the program and of the libraries that read and write for it fails once, in a run that"
        echo "finds its shader programs cached, in one that does not (cold; of its writes those to the cache), and in a sequence of two frames."
        echo "Calls: what a run makes; stopped: those of the tried that ended with an error; the others did not matter, and the output was the"
        echo "same, byte for byte. No partial target, no lost input, no other result, every next run completed."
        echo
        echo "| call | single: calls | tried | stopped | cold: calls | tried | stopped | sequence: calls | tried | stopped |"
        echo "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"
        for kind in $kinds; do
            row="| $kind"
            for form in single cold sequence; do
                row="$row | $(occurrences $kind $form) | $(tried $kind $form) | $(stopped $kind $form)"
            done
            echo "$row |"
        done
        echo
    } >"$SSDO_TABLES/90-calls.md"
fi
echo "figure: $(wc -l <"$dir/results") system calls failed once each, $(grep -vc ' 0$' "$dir/results") of them ended the frame: 0 partial targets, 0 lost inputs, 0 other results, every next run completed"
