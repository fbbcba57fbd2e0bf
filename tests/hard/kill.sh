#!/bin/sh
# A batch with previews and reports killed outright (SIGKILL) at random moments, many times: never a partial file under a target's
# name, never a changed input; a last run completes and leaves the same bytes as a run that nobody disturbed. SSDO_HARD=whole
# kills 200 times.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; exit 1; }
kills=12
[ "${SSDO_HARD-}" = whole ] && kills=200
mkdir "$dir/in" "$dir/good" "$dir/out"
for i in 1 2 3 4; do oiiotool samples/still.exr --cut 96x72+$((100 * i))+120 --origin +0+0 --fullpixels -o "$dir/in/f.000$i.exr" >/dev/null || die oiiotool; done
# batch FOLDER: the command that fills it.
batch() { exec "$SSDO" -q "$dir/in/f.####.exr" --samples 8 --threads 2 -o "$1/f.####.exr" --preview "$1/p.####.png" --report "$1/r.####.json" --skip-existing; }
start=$(date +%s%N)
(batch "$dir/good") || die "the undisturbed run"
span=$((($(date +%s%N) - start) / 1000000 + 50)) # milliseconds
(cd "$dir/in" && sha256sum *) >"$dir/inputs"
partial=0 seed=12345 k=0 hit=0
while [ $hit -lt $kills ] && [ $k -lt $((6 * kills)) ]; do
    k=$((k + 1)) seed=$(((seed * 1103515245 + 12345) % 2147483648))
    [ $((k % 2)) = 0 ] && rm -f "$dir"/out/*.*
    (batch "$dir/out") >/dev/null 2>&1 &
    pid=$!
    sleep "$(printf '%d.%03d' $((seed % span / 1000)) $((seed % span % 1000)))"
    kill -KILL $pid 2>/dev/null && hit=$((hit + 1))
    wait $pid 2>/dev/null
    for f in "$dir"/out/*.json; do
        [ ! -e "$f" ] || [ "$(tail -c 2 "$f")" = '}' ] || partial=$((partial + 1))
    done
    for f in "$dir"/out/*.exr "$dir"/out/*.png; do
        [ -e "$f" ] || continue
        cmp -s "$f" "$dir/good/$(basename "$f")" || partial=$((partial + 1))
    done
    (cd "$dir/in" && sha256sum -c --quiet "$dir/inputs") || die "an input changed after kill $k"
done
[ $partial = 0 ] || die "$partial partial files under a target's name after $kills kills"
left=$(find "$dir/out" -name '.*tmp' | wc -l)
(batch "$dir/out") || die "the run after the kills"
for i in 1 2 3 4; do cmp "$dir/out/f.000$i.exr" "$dir/good/f.000$i.exr" && cmp "$dir/out/p.000$i.png" "$dir/good/p.000$i.png" && [ -s "$dir/out/r.000$i.json" ] || die "frame $i differs after the kills"; done
[ -z "$(find "$dir/out" -name '.*tmp')" ] || die "the run after the kills leaves $(ls -A "$dir/out")"
echo "figure: killed $hit times at random moments of $span ms ($((k - hit)) runs were done before): 0 partial outputs, 0 lost inputs, $left hidden temporary files, completed and tidied"
