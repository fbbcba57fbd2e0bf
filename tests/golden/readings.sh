#!/bin/sh
# What a pass means is found, said and obeyed: world normals beside depth turn an environment, constant normals are doubted, a depth of
# 0..1 needs its range, half depths are warned of, --strict fails with 7, --explain=json holds every reading, check-wild makes a table.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
root=$PWD
die() { echo "FAILED: $*"; cat "$dir/said" 2>/dev/null; exit 1; }
said() { grep -qF -- "$1" "$dir/said" || die "not said: '$1' ($2)"; }
V=ViewLayer
cut() { # FILE CHANNELS [oiiotool arguments]
    to=$1 channels=$2
    shift 2
    oiiotool samples/still.exr --cut 240x135+100+60 --ch "$channels" --eraseattrib '.*' "$@" -o "$dir/$to" >/dev/null 2>&1 || die "oiiotool $to"
}
p="P.X=$V.Position.X,P.Y=$V.Position.Y,P.Z=$V.Position.Z"
n="N.X=$V.Normal.X,N.Y=$V.Normal.Y,N.Z=$V.Normal.Z"
mkdir "$dir/wild"
cut p.exr "$p" && cut pn.exr "$p,$n" && cut zn.exr "Z=$V.Depth.Z,$n"
cut wild/constant.exr "$p,N.X=0,N.Y=0,N.Z=1"
oiiotool "$dir/pn.exr" --ch N.X,N.Y,N.Z --mulc 0.5 --addc 0.5 "$dir/p.exr" --chappend -o "$dir/wild/encoded.exr" || die encoded
oiiotool "$dir/zn.exr" --ch Z --divc 40 --clamp:max=1 -o "$dir/unit.exr" || die unit
oiiotool "$dir/zn.exr" --ch Z -d half -o "$dir/half.exr" || die half
cp "$dir/pn.exr" "$dir/wild/plain.exr"

# The rotation that only the normals know.
"$SSDO" "$dir/zn.exr" --fov 40 --explain >"$dir/said" || die "depth and world normals"
said "a space of estimated rotation" zn
said "world directions: known by the normals" zn
"$SSDO" "$dir/zn.exr" --fov 40 -o "$dir/out.exr" --layers radiance --env samples/sky_soft.exr --quality draft -q || die "an environment by normals"

# Encoded normals give the plain file's picture.
for f in plain encoded; do
    "$SSDO" "$dir/wild/$f.exr" -o "$dir/$f.exr" --layers occlusion --radius 0.5 -q --strict || die "$f under --strict"
done
oiiotool "$dir/plain.exr" --ch occlusion.R "$dir/encoded.exr" --ch occlusion.R --fail 0.01 --diff >"$dir/said" 2>&1 || die "encoded normals"

# Doubt.
"$SSDO" "$dir/wild/constant.exr" -o "$dir/out2.exr" --strict >"$dir/said" 2>&1
[ $? = 7 ] && [ ! -e "$dir/out2.exr" ] || die "--strict on constant normals"
said "the normals all point one way" constant
"$SSDO" "$dir/wild/constant.exr" -o "$dir/out2.exr" --layers occlusion --radius 0.5 -q || die "constant normals are rebuilt"
"$SSDO" "$dir/p.exr" -o "$dir/out3.exr" --layers occlusion --radius 0.5 -q || die "no normals"
oiiotool "$dir/out2.exr" --ch occlusion.R "$dir/out3.exr" --ch occlusion.R --fail 0 --diff >"$dir/said" 2>&1 || die "rebuilt normals differ"

# Depth.
"$SSDO" "$dir/unit.exr" --fov 40 -o "$dir/out4.exr" --depth-kind linear >"$dir/said" 2>&1
[ $? = 3 ] || die "0..1 without a range"
said "--depth-range" unit
"$SSDO" "$dir/unit.exr" --fov 40 -o "$dir/out4.exr" --depth-kind linear --depth-range 0 40 --layers occlusion -q || die "0..1 with its range"
"$SSDO" "$dir/half.exr" --fov 40 -o "$dir/out5.exr" --layers occlusion >"$dir/said" 2>&1 || die half
said "depth is stored as half floats" half

# Without normals, planes and a background that is far away it may be 1 / z.
for empty in 0 1e10; do
    oiiotool --pattern constant:color=$empty 120x80 1 --pattern noise:type=uniform:min=3:max=4:seed=1:mono=1 100x60 1 \
        --paste +10+10 --chnames Z -d float -o "$dir/open_$empty.exr" || die "open $empty"
done
"$SSDO" "$dir/open_0.exr" --fov 40 -o "$dir/out6.exr" --layers occlusion --strict >"$dir/said" 2>&1
[ $? = 7 ] && [ ! -e "$dir/out6.exr" ] || die "a depth that may be 1 / z under --strict"
said "--depth-kind" "1 / z"
"$SSDO" "$dir/open_0.exr" --fov 40 --depth-kind inverse --explain >"$dir/said" 2>&1 || die "told that it is 1 / z"
grep -q "as 1 / z is" "$dir/said" && die "doubt of what was told"
"$SSDO" "$dir/open_1e10.exr" --fov 40 --explain >"$dir/said" 2>&1 || die "a background far away"
grep -q "as 1 / z is" "$dir/said" && die "doubt of a depth whose background is far away"

# For machines.
"$SSDO" "$dir/wild/encoded.exr" --explain=json >"$dir/said" || die json
python3 -c '
import json, sys
r = json.load(open(sys.argv[1]))
n = r["views"][0]["roles"]["normal"]
assert r["verdict"] == "read" and n["verdict"] == "taken" and n["reading"] == "0..1 encoded, world space", n
assert n["fit"] > 0.97 and len(n["hypotheses"]) > 3 and n["hypotheses"][0]["loss"] <= n["hypotheses"][1]["loss"], n
' "$dir/said" || die "the JSON's content"
"$SSDO" "$dir/unit.exr" --explain=json >"$dir/said" 2>/dev/null
[ $? = 3 ] || die "--explain=json of what is refused"
said '"verdict": "refused"' unit
cd "$root" && python3 tests/wild/check.py "$SSDO" "$dir/wild" >"$dir/said" || die "check-wild"
said "1 doubtful, 2 read; 0 crashed" check-wild
exit 0
