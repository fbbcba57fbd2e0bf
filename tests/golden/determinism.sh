#!/bin/sh
# The same input and options give the same bytes: whatever the threads, the locale, the clock, the folder and the driver's threads.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
run() { name=$1; shift; env "$@" "$SSDO" -q samples/still.exr -o "$dir/$name.exr" --env samples/sky_soft.exr --threads "${threads:-2}" || exit 1; }
run plain A=b
threads=1 run one A=b
threads=7 run seven A=b
run locale LC_ALL=de_DE.UTF-8 TZ=Asia/Tokyo
run llvmpipe0 LP_NUM_THREADS=0
run llvmpipe3 LP_NUM_THREADS=3
run cold MESA_SHADER_CACHE_DISABLE=true
run mapped SSDO_TRANSFER=mapped # as on hardware
for f in "$dir"/*.exr; do cmp "$dir/plain.exr" "$f" || { echo "FAILED: $(basename "$f") differs"; exit 1; }; done
# Rounds stop by sums, which must not depend on who adds them up.
for n in 1 3; do
    LP_NUM_THREADS=$n "$SSDO" -q samples/still.exr -o "$dir/rounds$n.exr" --env samples/sky_soft.exr --threads $n --error 0.02 || exit 1
done
cmp "$dir/rounds1.exr" "$dir/rounds3.exr" || { echo "FAILED: --error differs"; exit 1; }
echo "figure: $(ls "$dir" | grep -vc rounds) runs, the same bytes"
