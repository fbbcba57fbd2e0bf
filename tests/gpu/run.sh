#!/bin/sh
# run.sh [OUT]: what a farm's engineer runs first on a machine with a GPU, from the unpacked bundle (make gpu-bundle). It needs a driver,
# libEGL (glvnd) and a glibc as new as Debian 12's. It compares the samples' layers with recorded ones of llvmpipe, times frames by stage,
# a batch, and 2 and 4 processes at once, and runs the tests that use GL. It prints as it goes, and puts log and table into OUT
# (./results). Under four minutes on hardware; on a software device a short form of a minute. SSDO_DEVICE=N chooses the device.
set -u
here=$(cd "$(dirname "$0")" && pwd)
cd "$here" || exit 2
out=${1:-$here/results}
mkdir -p "$out" || exit 2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
XDG_CACHE_HOME=$work/cache
export XDG_CACHE_HOME
mkdir "$XDG_CACHE_HOME"
: >"$out/table.md"
passed=0 failed=0
filter() { bin/ssdo-filter ${SSDO_DEVICE:+--device "$SSDO_DEVICE"} "$@"; }
say() { echo "$*" | tee -a "$out/table.md"; }
good() { passed=$((passed + 1)); }
bad() { failed=$((failed + 1)); say "FAILED: $*"; }
now() { echo $(($(date +%s%N) / 1000000)); }

filter samples/box.exr -o "$work/first.exr" --samples 4 -v >"$work/log" 2>&1 || { cat "$work/log"; echo "gpu-bundle: no frame could be made"; exit 1; }
device=$(sed -n 's/.*device: //p' "$work/log" | head -1)
software=; case $device in *software*) software=1 ;; esac
say "$(cat version), $device, $(nproc) cores"
say "left out, since they need more than a driver: $(cat left-out)"
say ""

# ---- layers beside llvmpipe's. One sample that falls to the other side of an edge moves a pixel, not the mean.
say "| layers beside llvmpipe's | rms and largest difference |"
say "| --- | --- |"
while read -r name arguments <&3; do
    [ -z "$software" ] || case $name in box-* | ortho-* | *hemisphere) ;; *) continue ;; esac
    if filter $arguments -q --keep none -o "$work/layer.exr" >"$work/log" 2>&1 &&
        bin/compare "$work/layer.exr" "recorded/$name.exr" 0.002 >"$work/figures"; then
        good
    else
        bad "$name: $(tail -2 "$work/log")"
    fi
    say "| $name | $(tr '\n' ';' <"$work/figures") |"
done 3<cases.txt
say ""

# ---- time by stage: the second of two runs, so that no shader is compiled.
stages() { # REPORT: read resolve upload passes read-back convert write, in ms
    awk '/"stage":/ { gsub(/[",]/, ""); s = $0; sub(/.*stage: */, "", s) }
        /"wall_ms":/ && s != "" { gsub(/,/, ""); if (!(s in t)) t[s] = $2; s = "" }
        END { n = split("read,resolve,upload,passes,read_back,read back,convert,write,total", k, ",")
              for (i = 1; i <= n; i++) if (k[i] in t) printf "%s %.0f, ", k[i], t[k[i]]; print "" }' "$1"
}
frame() { # WIDTH HEIGHT QUALITY
    [ -e "$work/$1.exr" ] || bin/make_input "$1" "$2" "$work/$1.exr" || { bad "no input of $1 x $2"; return; }
    filter "$work/$1.exr" -q --quality "$3" -o "$work/out.exr" >"$work/log" 2>&1
    start=$(now)
    if filter "$work/$1.exr" -q --quality "$3" -o "$work/out.exr" >"$work/log" 2>&1; then good; else bad "$1 $3: $(tail -1 "$work/log")"; fi
    whole=$(($(now) - start))
    filter "$work/$1.exr" -q --quality "$3" -o "$work/out.exr" --report "$work/report.json" >"$work/log" 2>&1 || bad "report of $1 $3"
    say "| $1x$2 $3 | $whole | $(stages "$work/report.json") |"
}
say "| frame | whole job, wall ms | by stage, ms (a run of its own, which waits after every pass) |"
say "| --- | ---: | --- |"
if [ -n "$software" ]; then
    frame 480 270 standard
    frame 960 540 draft
else
    for quality in draft standard high; do frame 1920 1080 $quality; done
    for quality in draft standard high; do frame 3840 2160 $quality; done
fi
say ""

# ---- a batch, and several processes on one device
size=1920 frames=16
[ -z "$software" ] || { size=480; frames=4; }
for i in $(seq "$frames"); do ln -s "$work/$size.exr" "$work/in.$(printf %04d "$i").exr"; done
start=$(now)
if filter "$work/in.####.exr" -q -o "$work/batch.####.exr" --report "$work/batch.json" >"$work/log" 2>&1; then good; else bad "batch: $(tail -1 "$work/log")"; fi
say "batch of $frames frames, $size wide, standard: $((($(now) - start) / frames)) ms a frame; busy: $(sed -n '/"busy"/,/}/p' "$work/batch.json" | tr -d '\n" {}' | cut -c1-160)"
for n in 1 2 4; do
    start=$(now)
    for i in $(seq "$n"); do filter "$work/$size.exr" -q -o "$work/process$i.exr" >"$work/log$i" 2>&1 || echo failed >"$work/process.failed" & done
    wait
    say "$n processes at once, $size wide, standard: $(($(now) - start)) ms"
done
if [ -e "$work/process.failed" ]; then bad "processes at once"; else good; fi
say ""

# ---- tests, last: what came before is already written
for t in bin/test_* bin/hard_*; do
    name=$(basename "$t")
    [ -z "$software" ] || case $name in test_tiles | test_methods | test_vpl) ;; *) continue ;; esac
    start=$(now)
    timeout 120 "$t" >"$out/$name.log" 2>&1
    code=$?
    echo "$name $code $(($(now) - start)) ms"
    case $code in
    0 | 77) good ;;
    *) bad "$name (exit $code): $(grep -E 'ERROR|Error|error' "$out/$name.log" | head -2 | tr '\n' ' ' | cut -c1-300)" ;;
    esac
done
head -c 12000 "$out/table.md" >"$out/table.short" && mv "$out/table.short" "$out/table.md"
echo
cat "$out/table.md"
echo "gpu-bundle: $passed passed, $failed failed on $device"
[ "$failed" = 0 ]
