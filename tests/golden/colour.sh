#!/bin/sh
# Previews through a real OpenColorIO config (Blender's): its Standard view is sRGB, which is what there is without a config; Filmic
# is another; an unknown view lists those there are.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; exit 1; }
config=/usr/share/blender/datafiles/colormanagement/config.ocio
[ -r $config ] || { echo "no $config here (package blender-data)"; exit 77; }
unset OCIO
# The sheet's one cell: the legend below it names the display and view.
look() {
    "$SSDO" -q samples/still.exr -o "$dir/o.exr" --samples 4 --layers composite --preview "$dir/sheet.png" $2 || die "$1"
    oiiotool "$dir/sheet.png" --cut 492x300+0+0 -o "$dir/$1.png" || die oiiotool
    oiiotool "$dir/sheet.png" --cut 492x96+0+306 -o "$dir/$1.legend.ppm" || die oiiotool
}
look none ""
look standard "--ocio $config --view Standard"
look filmic "--ocio $config --view Filmic"
oiiotool --fail 0.004 --hardfail 0.004 --diff "$dir/none.png" "$dir/standard.png" >/dev/null || die "Standard is not sRGB"
oiiotool --fail 0.02 --diff "$dir/standard.png" "$dir/filmic.png" >/dev/null && die "Filmic changes nothing"
cmp -s "$dir/standard.legend.ppm" "$dir/filmic.legend.ppm" && die "the legend does not tell the views apart"
"$SSDO" -q samples/still.exr -o "$dir/o.exr" --samples 4 --layers composite --preview "$dir/x.png" --ocio $config --view Nice 2>"$dir/err" && die "taken"
grep -q 'Filmic' "$dir/err" && [ "$(wc -l <"$dir/err")" = 1 ] || die "$(cat "$dir/err")"
# The checkerboard of "no surface" is no light.
oiiotool "$dir/filmic.png" --cut 8x8+8+32 --origin +0+0 --fullpixels -o "$dir/corner.ppm" && oiiotool "$dir/none.png" --cut 8x8+8+32 --origin +0+0 --fullpixels -o "$dir/plain.ppm" || die oiiotool
cmp "$dir/corner.ppm" "$dir/plain.ppm" || die "the checkerboard goes through the view"

# The config of $OCIO, a display of several; mistakes are found before any frame is filtered.
export OCIO=$config
look default ""
oiiotool --fail 0 --diff "$dir/default.png" "$dir/standard.png" >/dev/null || die "\$OCIO gives another picture than --ocio"
# The second display of Blender's config: XYZ in 3.4, Rec.1886 in 4.3.
other=$(sed -n '/^displays:/,/^[a-z]*_/s/^  \([^ ]*\):$/\1/p' $config | sed -n 2p)
look xyz "--display $other --view Standard"
oiiotool --fail 0.02 --diff "$dir/standard.png" "$dir/xyz.png" >/dev/null && die "another display changes nothing"
rm "$dir"/*
"$SSDO" -q samples/still.exr -o "$dir/o.exr" --preview "$dir/x.png" --display LCD 2>"$dir/err" && die "taken"
grep -q "no display 'LCD'; it has sRGB, .*$other" "$dir/err" && [ "$(ls "$dir")" = err ] || die "$(ls "$dir"; cat "$dir/err")"
unset OCIO
"$SSDO" -q samples/still.exr -o "$dir/o.exr" --preview "$dir/x.png" --view Filmic 2>"$dir/err" && die "taken"
grep -q 'name one with --ocio' "$dir/err" && [ "$(ls "$dir")" = err ] || die "$(ls "$dir"; cat "$dir/err")"
exit 0
