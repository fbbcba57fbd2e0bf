#!/bin/sh
# One pass per file: the files of a frame give what one file with all passes gives, alone and as a sequence; mismatches are named.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; exit 1; }
V=ViewLayer
part() { oiiotool samples/still.exr --ch "$2" --eraseattrib '.*' -o "$dir/$1" >/dev/null 2>&1 || die "oiiotool $1"; }
part all.exr "P.R=$V.Position.X,P.G=$V.Position.Y,P.B=$V.Position.Z,N.X=$V.Normal.X,N.Y=$V.Normal.Y,N.Z=$V.Normal.Z,Z.Z=$V.Depth.Z,albedo.R=$V.DiffCol.R,albedo.G=$V.DiffCol.G,albedo.B=$V.DiffCol.B,R=$V.Combined.R,G=$V.Combined.G,B=$V.Combined.B,A=$V.Combined.A"
for n in 0001 0002; do
    part sh_010_P.$n.exr "R=$V.Position.X,G=$V.Position.Y,B=$V.Position.Z"
    part sh_010_N.$n.exr "X=$V.Normal.X,Y=$V.Normal.Y,Z=$V.Normal.Z"
    part sh_010_Z.$n.exr "Z=$V.Depth.Z"
    part sh_010_albedo.$n.exr "R=$V.DiffCol.R,G=$V.DiffCol.G,B=$V.DiffCol.B"
    part sh_010_beauty.$n.exr "R=$V.Combined.R,G=$V.Combined.G,B=$V.Combined.B,A=$V.Combined.A"
done
common="--samples 8"
"$SSDO" -q "$dir/all.exr" -o "$dir/want.exr" $common || die "the one file"
"$SSDO" -q "$dir"/sh_010_*.0001.exr -o "$dir/got.exr" $common || die "five files"
names() { oiiotool --info -v "$1" | sed -n 's/ *channel list: //p'; }
[ "$(names "$dir/want.exr")" = "$(names "$dir/got.exr")" ] || die "other channels: $(names "$dir/got.exr")"
oiiotool --diff "$dir/want.exr" "$dir/got.exr" >"$dir/diff" || die "other pixels: $(cat "$dir/diff")"
"$SSDO" -q "$dir/sh_010_P.####.exr" "$dir/sh_010_N.####.exr" "$dir/sh_010_Z.####.exr" "$dir/sh_010_albedo.####.exr" \
    "$dir/sh_010_beauty.####.exr" -o "$dir/seq.####.exr" $common || die "the sequence"
oiiotool --diff "$dir/want.exr" "$dir/seq.0002.exr" >/dev/null || die "the sequence's pixels"

# What only one file's header says comes through, a manifest and the camera; where two differ, the position's (or depth's) counts.
mkdir "$dir/head"
oiiotool "$dir/sh_010_Z.0001.exr" --attrib who depth -o "$dir/head/s_Z.exr" >/dev/null 2>&1
oiiotool "$dir/sh_010_beauty.0001.exr" --attrib who beauty --attrib cryptomatte/3ae39a5/manifest names \
    --attrib:type=matrix worldToNDC "2,0,0,0,0,3.5555556,0,0,0,0,1,1,0,0,0,0" -o "$dir/head/s_beauty.exr" >/dev/null 2>&1
"$SSDO" -q "$dir/head/s_beauty.exr" "$dir/head/s_Z.exr" -o "$dir/head.exr" --layers occlusion --samples 4 || die "a camera in the beauty's header"
exrheader "$dir/head.exr" >"$dir/header"
for line in '^cryptomatte/3ae39a5/manifest .*"names"' '^who .*"depth"' '^ssdo/camera .*source header' '^worldToNDC '; do
    grep -q "$line" "$dir/header" || die "no $line in: $(cat "$dir/header")"
done

# DWA goes through another reader, which knows the channels by their stored names.
oiiotool "$dir/sh_010_albedo.0001.exr" --compression dwaa -o "$dir/sh_010_albedo.0001.exr" >/dev/null 2>&1
"$SSDO" -q "$dir"/sh_010_*.0001.exr -o "$dir/dwa.exr" $common || die "a DWA pass among the files"

# A frame lacks one of its files.
rm "$dir/sh_010_N.0002.exr"
"$SSDO" "$dir/sh_010_P.####.exr" "$dir/sh_010_N.####.exr" -o "$dir/skip.####.exr" --missing skip --layers occlusion >"$dir/out" 2>&1 || die "--missing skip"
grep -q 'frame 2.*missing' "$dir/out" || die "the missing file was not noticed: $(cat "$dir/out")"

refuse() {
    text=$1
    shift
    "$SSDO" -q "$@" -o "$dir/no.exr" 2>"$dir/err" && die "taken: $*"
    grep -qF -- "$text" "$dir/err" && [ "$(wc -l <"$dir/err")" = 1 ] && [ ! -e "$dir/no.exr" ] || die "$(cat "$dir/err")"
}
oiiotool "$dir/sh_010_N.0001.exr" --resize 100x100 -o "$dir/sh_010_small.exr" >/dev/null 2>&1
refuse "display window of 100 x 100" "$dir/sh_010_P.0001.exr" "$dir/sh_010_small.exr"
mkdir "$dir/again" && cp "$dir/sh_010_P.0001.exr" "$dir/again"
refuse "this channel is in" "$dir/sh_010_P.0001.exr" "$dir/again/sh_010_P.0001.exr" "$dir/sh_010_N.0001.exr"
"$SSDO" -q "$dir/sh_010_P.0001.exr" "$dir/sh_010_N.0001.exr" -o "$dir/sh_010_N.0001.exr" 2>/dev/null && die "an input was overwritten"
exit 0
