#!/bin/sh
# What libdeflate wrote is read by others: for ZIP and ZIPS, in one part and in two, stock OpenEXR (exrmultipart), OpenImageIO and
# Blender find the very values that a file without compression holds.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; exit 1; }
for tool in oiiotool exrmultipart blender; do
    command -v $tool >/dev/null 2>&1 || { echo "no $tool here"; exit 77; }
done
V=ViewLayer
filter() { "$SSDO" -q "$dir/in.exr" -o "$1" --env samples/sky_soft.exr --quality draft --prefix $V. "$2" "$3" "$4" "$5" || die "ssdo-filter $*"; }
# channels FILE: its channel names, of all parts.
channels() { oiiotool --info -v -a "$1" | sed -n 's/ *channel list: //p' | sed 's/ ([a-z]*)//g; s/ //g' | tr '\n' ',' | sed 's/,$//'; }
# same A B: all channels that B holds, in whatever part, are A's, to the bit.
same() {
    parts=$(oiiotool --info -a "$2" | grep -c '^ *subimage')
    for i in $(seq 0 $((parts > 0 ? parts - 1 : 0))); do
        oiiotool "$2" --subimage "$i" -o "$dir/y.exr" || die "oiiotool cannot read $2"
        oiiotool "$1" --ch "$(channels "$dir/y.exr")" -o "$dir/x.exr" || die "$1 lacks channels"
        oiiotool --diff --fail 0 --warn 0 "$dir/x.exr" "$dir/y.exr" >"$dir/log" || die "$2, part $i: $(cat "$dir/log")"
    done
}

oiiotool samples/still.exr --cut 160x90+160+90 --origin +0+0 --fullpixels -o "$dir/in.exr" || die oiiotool
filter "$dir/none.exr" --compression none --layout single
oiiotool "$dir/none.exr" --ch R=$V.composite.R,G=$V.composite.G,B=$V.composite.B -d float -o "$dir/composite.exr"
files=
count=$(channels "$dir/none.exr" | tr ',' '\n' | wc -l)
for compression in zip zips; do
    for layout in single multipart; do
        f=$dir/$compression.$layout.exr
        filter "$f" --compression $compression --layout $layout
        exrheader "$f" | grep -q "compression.*zip" || die "$f is not compressed"
        [ "$(channels "$f" | tr ',' '\n' | wc -l)" = "$count" ] || die "$f lacks channels"
        same "$dir/none.exr" "$f"
        # OpenEXR's own library reads every chunk and writes it again, each part to a file.
        rm -f "$dir"/stock.*
        (cd "$dir" && exrmultipart -separate -i "$f" -o stock) >"$dir/log" 2>&1 || die "exrmultipart: $(cat "$dir/log")"
        for g in "$dir"/stock.*; do same "$dir/none.exr" "$g"; done
        files="$files $f $dir/seen.$compression.$layout/"
    done
done
# Their composites as Blender's compositor has them.
# shellcheck disable=SC2086
blender -b --factory-startup -P tests/hosts/rebuild.py -- $files >"$dir/blender.log" 2>&1
for compression in zip zips; do
    for layout in single multipart; do
        f=$dir/seen.$compression.$layout/composite0001.exr
        [ -e "$f" ] || die "Blender does not show the composite of $compression, $layout: $(cat "$dir/blender.log")"
        oiiotool "$f" --ch R,G,B -o "$dir/y.exr"
        oiiotool --diff --fail 0 --warn 0 "$dir/composite.exr" "$dir/y.exr" >"$dir/log" ||
            die "Blender shows other values of $compression, $layout: $(cat "$dir/log")"
    done
done
# The same with the input's chunks copied as they are (a multipart file without --compression).
filter "$dir/copied.exr" --layout multipart --keep all
same "$dir/none.exr" "$dir/copied.exr"
echo "figure: $count channels, ZIP and ZIPS, one part and two: equal in OpenEXR, OpenImageIO and Blender"
