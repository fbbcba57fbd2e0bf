#!/bin/sh
# compare_builds.sh OLD NEW [NAME]: whether two builds of ssdo-filter give the same bytes, over every sample by every method and over the
# modes of tests/compare_builds.txt; with NAME only those whose name holds it. Everything of a file is compared but the version and the
# digest, which name the build; of a preview, its picture. Exits 1 if anything differs, and says what.
#
# What OLD makes is kept in $COMPARE_DIR (/tmp/compare_builds) by the build's checksum, so that a second run makes only NEW's half. The
# samples are taken at a third of their size; with COMPARE_FULL=1 as they are, which takes five times as long.
set -u
cd "$(dirname "$0")/.." || exit 2
old=$1 new=$2 only=${3:-}
work=${COMPARE_DIR:-/tmp/compare_builds}
kept=$work/$(cksum <"$old" | tr ' ' -)${COMPARE_FULL:+-full} made=$work/new.$$ inputs=samples
mkdir -p "$kept" "$made" "$work/cache" "$work/small/proxies" "$work/small/covered" || exit 2
trap 'rm -rf "$made"' EXIT
XDG_CACHE_HOME=$work/cache
export XDG_CACHE_HOME
jobs=${COMPARE_JOBS:-2}

# The middle of every block of 3 x 3 pixels, whose centre is the small pixel's.
if [ -z "${COMPARE_FULL:-}" ]; then
    inputs=$work/small
    cp samples/sky_*.exr samples/*.obj samples/*.mtl "$inputs" && cp samples/proxies/*.json "$inputs/proxies" &&
        cp samples/covered/sky_*.exr "$inputs/covered" || exit 2
    for s in still box horizon ortho thin proxies/beside covered/room covered/corner; do
        size=$(oiiotool --info samples/$s.exr | sed -n 's/.*: *\([0-9]*\) x *\([0-9]*\).*/\1 \2/p' | head -1)
        [ -e "$inputs/$s.exr" ] || oiiotool samples/$s.exr --resample "$((${size% *} / 3))x$((${size#* } / 3))" -d float -o "$inputs/$s.exr" || exit 2
    done
fi

cases() {
    for sample in still box horizon ortho thin; do
        for method in arc ssdo alchemy hemisphere hbao s3ho gtao bitmask; do
            samples=16
            case $method in arc | gtao | bitmask) samples=64 ;; esac
            echo "$sample-$method samples/$sample.exr --method $method --samples $samples --env samples/sky_soft.exr"
        done
    done
    grep -v '^#' tests/compare_builds.txt
}

run() { # BUILD FOLDER NAME ARGUMENTS...: the output, or what was said instead
    build=$1 base=$2/$3
    shift 3
    "$build" -q $(echo "$*" | sed "s|@|$base|g; s|samples/|$inputs/|g") -o "$base.exr" 2>"$base.log" || mv "$base.log" "$base.failed"
}

# Of the cases whose turn it is, the differences; a line for each that has none.
compare() { # TURN
    turn=0
    while read -r name arguments <&3; do
        case $name in *"$only"*) turn=$((turn + 1)) ;; *) continue ;; esac
        [ $((turn % jobs)) = "$1" ] || continue
        [ -e "$kept/$name.exr" ] || [ -e "$kept/$name.failed" ] || run "$old" "$kept" "$name" "$arguments"
        run "$new" "$made" "$name" "$arguments"
        if [ -e "$kept/$name.failed" ] && [ -e "$made/$name.failed" ]; then
            difference=$(cmp -s "$kept/$name.failed" "$made/$name.failed" || echo "both fail, in other words")
        elif [ -e "$kept/$name.failed" ]; then
            difference="OLD alone fails: $(head -1 "$kept/$name.failed")"
        elif [ -e "$made/$name.failed" ]; then
            difference="NEW alone fails: $(head -1 "$made/$name.failed")"
        else
            difference=$(python3 tests/compare_builds.py "$kept/$name.exr" "$made/$name.exr" 2>&1)
        fi
        if [ -z "$difference" ]; then echo same >>"$made/result.$1"; else echo "$name: $difference" | tee -a "$made/result.$1"; fi
        rm -f "$made/$name".*
    done 3<<END
$(cases)
END
    echo end >>"$made/result.$1"
}

for turn in $(seq 0 $((jobs - 1))); do compare "$turn" & done
wait
same=$(cat "$made"/result.* | grep -cx same)
different=$(cat "$made"/result.* | grep -cE '^[-a-z0-9]+: ')
echo "compare_builds: $same outputs are the same, $different differ"
[ "$different" = 0 ] && [ "$same" -gt 0 ] && [ "$(cat "$made"/result.* | grep -cx end)" = "$jobs" ]
