#!/bin/sh
# Every technique on every sample, a fifth of their size: it runs, its layers are finite and hold something, and no two techniques
# give the same picture. The meshes and proxies are made afresh by the committed script; both tracers agree on each scene.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; exit 1; }
names='still horizon thin box ortho'

n=0
for s in $names; do
    n=$((n + 1))
    # The middle of every block of 5 x 5 pixels, whose centre is the small pixel's.
    oiiotool samples/$s.exr --resample 96x54 -d float -o "$dir/in.000$n.exr" || die "oiiotool"
    cp samples/proxies/$s.json "$dir/proxies.000$n.json"
done
cp samples/sky_*.exr "$dir"
blender -b --factory-startup -P samples/render.py -- --all --out "$dir" --export-obj --export-proxies >"$dir/blender.log" 2>&1 || die "$(tail -3 "$dir/blender.log")"
for s in $names; do cmp "$dir/proxies/$s.json" samples/proxies/$s.json || die "samples/proxies/$s.json is not what the script makes"; done
cmp "$dir/box.obj" samples/box.obj && cmp "$dir/box.mtl" samples/box.mtl || die "samples/box.obj is not what the script makes"

# check NAME LAYERS FILE...: finite values in all channels, more than one in some channel of every layer; writes down the hashes.
check() {
    what=$1 layers=$2
    shift 2
    oiiotool --info -v --stats --hash "$@" >"$dir/stats" 2>&1 || die "$what: $(cat "$dir/stats")"
    awk -v what="$what" -v wanted="$layers" '
        function complain(text) { print what ": " text " (" file ")"; bad = 1 }
        / : / && /channel,/ { file = $1; sub(".*/", "", file) }
        /channel list:/ { sub(/.*channel list: /, ""); gsub(/ \([a-z]*\)/, ""); count = split($0, channels, /, /) }
        /Stats StdDev:/ {
            split("", varies)
            for (i = 1; i <= count; i++) { layer = channels[i]; sub(/\..*/, "", layer); if ($(i + 2) > 0) varies[layer] = 1 }
            n = split(wanted, list, ",")
            for (i = 1; i <= n; i++) if (!(list[i] in varies)) complain("nothing in layer " list[i])
        }
        /Stats (Nan|Inf)Count:/ { for (i = 3; i <= NF; i++) if ($i != 0) complain("not finite: " $0) }
        /SHA-1:/ { sub(/.*SHA-1: /, ""); hashes[++files] = $0 " " what " " file }
        END { if (bad || !files) exit 1; for (i = 1; i <= files; i++) print hashes[i] }' "$dir/stats" >"$dir/found" || die "$(cat "$dir/found")"
    cat "$dir/found" >>"$dir/hashes"
}

# technique NAME LAYERS OPTION...: all samples as one sequence.
technique() {
    name=$1 layers=$2
    shift 2
    "$SSDO" -q "$dir/${from:-in}.####.exr" -o "$dir/$name.####.exr" --keep none --samples 8 --radius 8px --layers "$layers" "$@" || die "$name"
    check "$name" "$layers" "$dir/$name".000?.exr
    [ "$(grep -c " $name " "$dir/hashes")" = 5 ] || die "$name: not five pictures"
}

all=occlusion,radiance,indirect,composite
env="--env $dir/sky_soft.exr"
technique arc $all,bent,visibility $env
technique error $all,error,bent $env --error 0.02 --samples 512
technique half $all,bent $env --resolution half
technique proxies $all $env --proxies "$dir/proxies.####.json"
technique ssdo $all $env --method ssdo
technique s3ho occlusion,radiance,sh_0,sh_1,sh_2 $env --method s3ho
technique sigma occlusion,radiance,sh_0,sh_1,sh_2 $env --method s3ho --sh-sigma 0.5
technique bands3 occlusion,radiance,sh_0,sh_1,sh_2,sh_3 $env --method s3ho --sh-bands 3 --keep all # the relight needs the depth
from=bands3 technique relit radiance --env "$dir/sky_sun.exr" --from-sh --sh-bands 3
technique hemisphere occlusion,radiance $env --method hemisphere
technique hbao occlusion,radiance $env --method hbao
technique bias occlusion,radiance $env --method hbao --angle-bias 30
# A method that makes no light of its own has its occlusion for visibility.
technique visible composite $env --method hbao --mode visibility
technique alchemy occlusion,radiance $env --method alchemy
technique gtao occlusion,radiance,bent $env --method gtao
technique gtao-error occlusion,error,bent --method gtao --error 0.02 --samples 512
technique bitmask occlusion,radiance,bent $env --method bitmask
technique none radiance,composite $env --bounce none
technique bounce-ssdo indirect $env --bounce ssdo
technique vpl indirect $env --bounce vpl --vpl-count 32
technique mask depthmask,composite
technique strength depthmask,composite --depthmask-strength 3
technique scale occlusion,composite --scale 2
technique contrast occlusion,composite --contrast 2
technique all occlusion,composite --multiply all
technique scene occlusion,composite --preset scene
technique closeup occlusion,composite --preset closeup

i=0
for s in $names; do
    i=$((i % 5 + 1))
    for back in embree gpu; do
        "$SSDO" -q "$dir/in.000$i.exr" -o "$dir/$back.exr" --keep none --samples 2 --radius 8px --layers occlusion,radiance,indirect $env \
            --method raytrace --mesh "$dir/$s.obj" --trace $back || die "raytrace, $back, on $s"
    done
    check "raytrace, $s" occlusion,radiance,indirect "$dir/embree.exr" "$dir/gpu.exr"
    # Rays that graze an edge may differ: in one pixel of two hundred.
    oiiotool "$dir/embree.exr" "$dir/gpu.exr" --fail 0.01 --failpercent 0.5 --diff >"$dir/diff" || die "the tracers differ on $s: $(cat "$dir/diff")"
done
[ -z "$(grep -v raytrace "$dir/hashes" | cut -d' ' -f1 | sort | uniq -d)" ] || die "the same picture twice: $(sort "$dir/hashes" | uniq -D -w 40)"
echo "figure: $(wc -l <"$dir/hashes") pictures"
