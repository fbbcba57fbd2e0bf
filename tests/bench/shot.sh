#!/bin/sh
# shot.sh BUILD DIR OUT [OPTION...]: how much more occlusion changes than its truth over the shot `drape` in DIR (samples/render.py --shot), in
# which a curtain leaves the frame: each frame by itself, and with frames of the shot as further G-buffers.
set -e
build=$1 dir=$2 out=$3
shift 3
frames=$(find "$dir" -name 'drape.[0-9]*.exr' | wc -l)
echo '| drape | points | change beyond the truth'"'"'s, rms |'
echo '| --- | ---: | ---: |'
for surround in none shot; do
    mkdir -p "$out/$surround"
    "$build/ssdo-filter" -q "$dir/drape.####.exr" -o "$out/$surround/drape.####.exr" --layers occlusion --radius 0.8 --keep none --float \
        --surround $surround "$@"
    "$build/tests/bench/follow" "$dir" drape "$out/$surround" "$frames" | sed "s/^| drape/| --surround $surround/"
done
