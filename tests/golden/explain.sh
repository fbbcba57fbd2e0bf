#!/bin/sh
# --explain names the renderer and its evidence, marks rows that no real file has confirmed, and writes nothing; damage by a real DWA
# encoder is named.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; cat "$dir/out" 2>/dev/null; exit 1; }
has() { grep -qF -- "$1" "$dir/out" || die "no '$1' in $2"; }
V=ViewLayer

(cd "$dir" && "$SSDO" "$OLDPWD/samples/still.exr" --explain >"$dir/out") || die "still"
[ "$(ls "$dir")" = out ] || die "something was written: $(ls "$dir")"
has "convention  blender, recognised by the header's BlenderMultiChannel" still
has "position: $V.Position.X/Y/Z" still
has "normals: world space" still
has "layers: occlusion radiance indirect composite" still
grep -q unverified "$dir/out" && die "Blender is confirmed"
grep -q warnings "$dir/out" && die "a sound file was warned of"

# Another renderer's names, and its mark.
oiiotool samples/still.exr --ch "P.X=$V.Position.X,P.Y=$V.Position.Y,P.Z=$V.Position.Z,N.X=$V.Normal.X,N.Y=$V.Normal.Y,N.Z=$V.Normal.Z,Z=$V.Depth.Z" \
    --eraseattrib '.*' --attrib arnold/camera/near_clip 0.1 --attrib arnold/aovs/P/filter gaussian_filter -o "$dir/arnold.exr" || die oiiotool
"$SSDO" "$dir/arnold.exr" --explain >"$dir/out" || die "arnold"
has "convention  arnold (unverified), recognised by the header's arnold/*" arnold
has "the position pass is anti-aliased (the header says gaussian_filter)" arnold

oiiotool samples/still.exr --compression dwaa:45 -o "$dir/dwa.exr" >/dev/null 2>&1 || die "oiiotool dwaa"
"$SSDO" "$dir/dwa.exr" --explain >"$dir/out" || die "dwa"
has "$V.Position.Y: DWA compression" dwa
has "$V.Normal.Y: DWA compression" dwa
grep -F 'DWA' "$dir/out" | sed 's/^ */figure: /'

# An unusable input: what was found, then the error.
oiiotool samples/still.exr --ch "$V.Depth.Z" -o "$dir/depth.exr" >/dev/null 2>&1
"$SSDO" "$dir/depth.exr" --explain >"$dir/out" 2>"$dir/err" && die "a lone depth was taken"
has "depth: $V.Depth.Z" depth
grep -qF -- --fov "$dir/err" || die "no remedy"

# Names that hold a line's end, an escape sequence and no UTF-8 command no terminal and forge no line; the same length keeps the file
# whole.
oiiotool samples/still.exr --cut 40x32+200+120 --origin +0+0 --fullpixels -o "$dir/odd.exr" || die oiiotool
odd="$dir/$(printf 'a\nssdo-filter: b\033[2J\377.exr')"
LC_ALL=C sed 's/ViewLayer\./V\x0a\x1b[2J\xffer./g' "$dir/odd.exr" >"$odd" || die sed
"$SSDO" "$odd" --explain >"$dir/out" 2>&1 || die "odd names"
has 'V??[2J?er.Position.X/Y/Z' "odd names"
has 'a?ssdo-filter: b?[2J?.exr' "odd names"
[ "$(LC_ALL=C tr -d '\n\040-\176' <"$dir/out" | wc -c)" = 0 ] || die "odd names come through"
"$SSDO" "$odd" -o "$dir/nowhere/out.exr" 2>"$dir/out" && die "no folder"
"$SSDO" "$odd" --position none.X -o "$dir/out.exr" 2>>"$dir/out" && die "no position"
[ "$(LC_ALL=C tr -d '\n\040-\176' <"$dir/out" | wc -c)" = 0 ] || die "odd names come through errors"
[ "$(wc -l <"$dir/out")" = 2 ] || die "errors of other than a line"
exit 0
