#!/bin/sh
# Bad input, each case: one sentence, the documented exit code, no output file. $SSDO is the program.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
bad=0
sample=samples/still.exr

# expect CODE TEXT ARGS...: runs, and checks the exit code, that stderr is one line holding TEXT, and that no output appeared.
expect() {
    want=$1 text=$2
    shift 2
    rm -f "$dir/out.exr"
    "$SSDO" -q "$@" 2>"$dir/err" >/dev/null
    code=$?
    lines=$(wc -l <"$dir/err")
    if [ $code != "$want" ] || [ "$lines" != 1 ] || ! grep -qF -- "$text" "$dir/err" || [ -e "$dir/out.exr" ] ||
        [ -n "$(find "$dir" -name '*.tmp*' -o -name '.*exr*')" ]; then
        echo "FAILED: exit $code (wanted $want), wanted text '$text': $*"
        cat "$dir/err"
        bad=1
    fi
}

chan() { oiiotool "$sample" --ch "$1" -o "$dir/$2" >/dev/null 2>&1; }
V=ViewLayer
chan "$V.Normal.X,$V.Normal.Y,$V.Normal.Z,$V.DiffCol.R,$V.DiffCol.G,$V.DiffCol.B" noposition.exr
chan "$V.AO.R" nothing.exr
chan "$V.Depth.Z" depthonly.exr
chan "$V.Position.X,$V.Position.Y,$V.Position.Z,$V.Normal.X,$V.Normal.Y,$V.Normal.Z" noalbedo.exr
head -c 20000 "$sample" >"$dir/truncated.exr"
echo 'this is a text file' >"$dir/text.exr"

expect 3 "position" "$dir/noposition.exr" -o "$dir/out.exr"
expect 3 "position" "$dir/nothing.exr" -o "$dir/out.exr"
expect 3 "--fov" "$dir/depthonly.exr" -o "$dir/out.exr"
expect 3 "truncated.exr" "$dir/truncated.exr" -o "$dir/out.exr"
expect 3 "not an OpenEXR file" "$dir/text.exr" -o "$dir/out.exr"
expect 3 "missing.exr" "$dir/missing.exr" -o "$dir/out.exr"
SSDO_MEMORY=1000000
export SSDO_MEMORY
expect 6 "GiB free" "$sample" -o "$dir/out.exr"
unset SSDO_MEMORY
expect 3 "albedo" "$dir/noalbedo.exr" -o "$dir/out.exr" --layers indirect
expect 3 "'roughness'" "$sample" -o "$dir/out.exr" --layers specular --env samples/sky_soft.exr
expect 4 "no/such/folder" "$sample" -o "$dir/no/such/folder/out.exr"
expect 4 "no/such/folder" "$sample" -o "$dir/out.exr" --preview "$dir/no/such/folder/out.png"
expect 4 "no/such/folder" "$sample" -o "$dir/out.exr" --report "$dir/no/such/folder/out.json"
expect 2 "--radius" "$sample" -o "$dir/out.exr" --radius tiny
expect 2 "there is no layer" "$sample" -o "$dir/out.exr" --layers occlusoin
expect 2 "there is no method" "$sample" -o "$dir/out.exr" --method magic
expect 2 "--mesh" "$sample" -o "$dir/out.exr" --method raytrace
expect 3 "no_mesh.obj" "$sample" -o "$dir/out.exr" --method raytrace --mesh no_mesh.obj
expect 3 "no face" "$sample" -o "$dir/out.exr" --method raytrace --mesh "$dir/text.exr"
expect 3 "of the picture's points" "$sample" -o "$dir/out.exr" --method raytrace --mesh samples/box.obj
expect 2 "not with ssdo" "$sample" -o "$dir/out.exr" --error 0.02 --method ssdo
expect 2 "full resolution" "$sample" -o "$dir/out.exr" --error 0.02 --resolution half
expect 2 "at least 64" "$sample" -o "$dir/out.exr" --error 0.02 --samples 63
expect 2 "--error must be" "$sample" -o "$dir/out.exr" --error 1
expect 3 "it needs --error" "$sample" -o "$dir/out.exr" --layers error
expect 2 "--frobnicate" "$sample" -o "$dir/out.exr" --frobnicate
expect 3 "no_sky.exr" "$sample" -o "$dir/out.exr" --env no_sky.exr
# A driver list that names nothing: no EGL on this machine, as far as the program can see.
__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent export __EGL_VENDOR_LIBRARY_FILENAMES
expect 5 "OpenGL 4.5" "$sample" -o "$dir/out.exr"
unset __EGL_VENDOR_LIBRARY_FILENAMES

# The input as output is refused, and stays as it was.
cp "$sample" "$dir/in.exr"
"$SSDO" -q "$dir/in.exr" -o "$dir/../$(basename "$dir")/in.exr" 2>"$dir/err"
[ $? = 2 ] && cmp -s "$sample" "$dir/in.exr" || { echo "FAILED: the input was not kept"; bad=1; }

# A missing normal is no error: it comes from the depth, with a warning.
oiiotool "$sample" --ch "$V.Position.X,$V.Position.Y,$V.Position.Z,$V.Depth.Z" -o "$dir/nonormal.exr" >/dev/null 2>&1
"$SSDO" "$dir/nonormal.exr" -o "$dir/out.exr" --layers occlusion 2>"$dir/err" && grep -qi normal "$dir/err" && [ -s "$dir/out.exr" ] ||
    { echo "FAILED: a missing normal"; cat "$dir/err"; bad=1; }

# An older target survives a failure.
echo old >"$dir/old.exr"
"$SSDO" -q "$dir/truncated.exr" -o "$dir/old.exr" 2>/dev/null
[ "$(cat "$dir/old.exr")" = old ] || { echo "FAILED: the old target is gone"; bad=1; }
exit $bad
