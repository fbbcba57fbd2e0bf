#!/bin/sh
# What is written is compared with all that is read and with what else is written, for every frame and through links, before any
# work: exit code 2, one sentence with both names, every file as it was. And one damaged frame does not stop the others.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; [ -s "$dir/err" ] && cat "$dir/err"; exit 1; }
cd "$dir" || exit 1
samples=$OLDPWD/samples
oiiotool "$samples/still.exr" --cut 96x72+200+120 --origin +0+0 --fullpixels -o in.exr || die oiiotool
for i in 1 2 3 4; do cp in.exr f.000$i.exr; done
cp "$samples/sky_soft.exr" env.exr
echo '{"fov": 50}' >camera.json
echo '{"spheres": []}' >proxies.json
cp proxies.json p.0003.json
cp in.exr also.exr
printf 'mtllib mesh.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >mesh.obj
echo 'newmtl a' >mesh.mtl
printf 'ocio_profile_version: 1\n' >config.ocio
ln -s in.exr link.exr
ln in.exr hard.exr
ln -s f.0003.exr chain && ln -s chain g.0002.exr
mkdir folder && ln -s . folder/here && ln -s ../new.exr folder/dangling.png && ln -s new.exr chained && ln -s chained dangling
sha256sum *.exr *.json *.obj *.mtl *.ocio >sums
tried=0
# same TEXT ARGS: refused for TEXT, and nothing changed.
same() {
    text=$1
    shift
    "$SSDO" -q --samples 4 "$@" 2>err >/dev/null
    code=$?
    [ $code = 2 ] || die "$*: exit code $code"
    [ "$(wc -l <err)" = 1 ] && grep -qF "$text" err || die "$*: no '$text'"
    sha256sum -c --quiet sums || die "$*: a file changed"
    [ -z "$(find . -name '*tmp*' -o -name 'o.*' -o -name 'new*')" ] || die "$* left or made something: $(ls)"
    tried=$((tried + 1))
}
same 'the output and the input are' in.exr -o in.exr
same 'the output and the input are' in.exr -o link.exr
same 'the output and the input are' in.exr -o hard.exr
same 'the output and the input are' in.exr f.0001.exr -o ./f.0001.exr
same 'the report and the input are' in.exr -o o.exr --report in.exr
same 'the preview and the input are' in.exr -o o.exr --preview link.exr
same 'the output and --env are' in.exr -o env.exr --env env.exr
same 'the output and --camera are' in.exr -o camera.json --camera camera.json
same 'the output and --also are' in.exr -o also.exr --also also.exr
same 'the report and --proxies are' in.exr -o o.exr --proxies proxies.json --report proxies.json
same 'the output and --mesh are' in.exr -o mesh.obj --mesh mesh.obj --method raytrace
same 'the report and a material file of --mesh are' in.exr -o o.exr --mesh mesh.obj --method raytrace --report mesh.mtl
same 'the report and the OpenColorIO config are' in.exr -o o.exr --ocio config.ocio --report config.ocio
same 'the preview and the output are' in.exr -o new.exr --preview new.exr
same 'the report and the output are' in.exr -o new.exr --report folder/here/../new.exr
same 'the preview and the output are' in.exr -o new.exr --preview folder/dangling.png
same 'the report and the output are' in.exr -o new.exr --report dangling
same 'the report and the preview are' in.exr -o o.exr --report new.x --preview ./new.x
same 'the output of frame 1 and the input are' 'f.####.exr' -o 'f.%04d.exr'
same 'the report of frame 1 and the input are' 'f.####.exr' -o 'o.####.exr' --report 'f.####.exr'
same 'the preview of frame 2 and the input are' 'f.####.exr' -o 'o.####.exr' --preview 'f.####.exr' --preview-every 2
same 'the output of frame 2 and the input are' 'f.####.exr' -o 'g.####.exr'
same 'the output of frame 1 and --proxies are' 'f.####.exr' -o 'p.####.json' --proxies 'p.####.json'
same 'the report and the input are' 'f.####.exr' -o 'o.####.exr' --report f.0004.exr
same 'the report and the output are' 'f.####.exr' -o 'new.####.exr' --report new.0002.exr

# The same input twice, and one input for all frames, are nobody's loss.
"$SSDO" -q --samples 4 in.exr -o o.exr --report o.json --preview o.png || die "three targets"
"$SSDO" -q --samples 4 in.exr -o o.exr --report o.json --preview o.png || die "targets that exist"

# The lowest frame cannot be read.
mkdir o && head -c 20000 f.0001.exr >cut && mv cut f.0001.exr
"$SSDO" 'f.####.exr' -o 'o/f.####.exr' --samples 4 2>err >/dev/null
[ $? = 3 ] && grep -q -- '--radius-from' err || die "a damaged lowest frame without --keep-going"
[ -z "$(ls o)" ] || die "written all the same"
"$SSDO" 'f.####.exr' -o 'o/f.####.exr' --samples 4 --keep-going --report o.json 2>err >/dev/null
[ $? = 1 ] || die "a damaged lowest frame with --keep-going"
[ "$(echo o/*)" = 'o/f.0002.exr o/f.0003.exr o/f.0004.exr' ] || die "frames are missing: $(ls o)"
[ "$(grep -c 'the automatic radius and --outside auto are from frame 2' err)" = 1 ] || die "the radius is not told once"
mkdir t && "$SSDO" -q 'f.####.exr' -o 't/f.####.exr' --samples 4 --keep-going --frames 4 || die "a task"
cmp o/f.0004.exr t/f.0004.exr || die "another task has another radius"
"$SSDO" -q 'f.####.exr' -o 't/f.####.exr' --samples 4 --radius-from 3 --frames 2 || die "--radius-from"
echo "figure: $tried collisions refused, 0 files touched; 3 of 4 frames beside a damaged lowest one"
