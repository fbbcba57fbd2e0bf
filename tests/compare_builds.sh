#!/bin/sh
# compare_builds.sh OLD NEW [NAME]: whether two builds of ssdo-filter give the same bytes, over every sample by every method and over the
# modes of tests/compare_builds.txt; with NAME only those whose name holds it. Everything of a file is compared but the version and the
# digest, which name the build; of a preview, its picture. Exits 1 if anything differs, and says what.
#
# What OLD makes is kept in $COMPARE_DIR (/tmp/compare_builds) by the build's checksum, so that a second run makes only NEW's half.
set -u
cd "$(dirname "$0")/.." || exit 2
old=$1 new=$2 only=${3:-}
work=${COMPARE_DIR:-/tmp/compare_builds}
kept=$work/$(cksum <"$old" | tr ' ' -) made=$work/new.$$
mkdir -p "$kept" "$made" "$work/cache" || exit 2
trap 'rm -rf "$made"' EXIT
XDG_CACHE_HOME=$work/cache
export XDG_CACHE_HOME
same=0 different=0

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
    "$build" -q $(echo "$*" | sed "s|@|$base|g") -o "$base.exr" 2>"$base.log" || mv "$base.log" "$base.failed"
}

while read -r name arguments <&3; do
    case $name in *"$only"*) ;; *) continue ;; esac
    [ -e "$kept/$name.exr" ] || [ -e "$kept/$name.failed" ] || run "$old" "$kept" "$name" "$arguments"
    run "$new" "$made" "$name" "$arguments"
    if [ -e "$kept/$name.failed" ] || [ -e "$made/$name.failed" ]; then
        difference=$(cat "$kept/$name.failed" "$made/$name.failed" 2>&1 | head -2)
    else
        difference=$(python3 tests/compare_builds.py "$kept/$name.exr" "$made/$name.exr" 2>&1)
    fi
    if [ -z "$difference" ]; then
        same=$((same + 1))
    else
        different=$((different + 1))
        echo "$name: $difference"
    fi
    rm -f "$made/$name".*
done 3<<END
$(cases)
END
echo "compare_builds: $same outputs are the same, $different differ"
[ "$different" = 0 ] && [ "$same" -gt 0 ]
