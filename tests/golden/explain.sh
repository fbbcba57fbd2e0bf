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
exit 0
