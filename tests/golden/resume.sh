#!/bin/sh
# --skip-existing: a frame counts as done only if this very run would make the same bytes: whatever else is changed, it is made again.
# What decides nothing (times, paths, threads, comments) changes no byte and makes no frame again.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; [ -s "$dir/log" ] && cat "$dir/log"; exit 1; }
here=$PWD
cd "$dir" || exit 1
cut() { oiiotool "$here/samples/still.exr" --cut "$1" --origin +0+0 --fullpixels -o "$2" || die oiiotool; }
cut 40x32+200+120 in.exr
cut 40x32+210+120 other.exr
mkdir a b
oiiotool "$here/samples/sky_soft.exr" --resize 64x32 -o a/sky.exr || die oiiotool
oiiotool a/sky.exr --mulc 2 -o b/sky.exr || die oiiotool
echo '{"fov": 50}' >camera.json
echo '{"fov": 51}' >camera2.json
tried=0
run() { "$SSDO" --samples 4 "$@" --skip-existing >log 2>&1 || die "$*"; }
# redo WHAT ARGS...: the run makes the frame, and the next one of the same line leaves it out.
redo() {
    what=$1
    shift
    run "$@"
    grep -q skipped log && die "$what: taken for done"
    run "$@"
    grep -q 'skipped, already done' log || die "$what: made twice"
    tried=$((tried + 1))
}
kept() { what=$1; shift; run "$@"; grep -q 'skipped, already done' log || die "$what: made again"; }
o='-o out.exr'
redo first in.exr $o
kept 'the same line' in.exr $o
kept threads in.exr $o --threads 1
touch in.exr
kept 'a touched input' in.exr $o
cp in.exr elsewhere.exr
kept 'a copy of the input' elsewhere.exr $o
redo 'another input' other.exr $o
redo 'back' in.exr $o
redo --camera in.exr $o --camera camera.json
redo 'another --camera' in.exr $o --camera camera2.json
redo --keep in.exr $o --keep none
redo --prefix in.exr $o --prefix x_
redo --layout in.exr $o --layout multipart
redo --compression in.exr $o --compression piz
redo --samples in.exr $o --samples 8
redo --env in.exr $o --env a/sky.exr
redo 'an environment of the same name elsewhere' in.exr $o --env b/sky.exr

# The same of a multi-part file whose first part is an earlier output.
cp out.exr old.exr
redo 'our own output as input' old.exr -o again.exr --layout multipart --prefix y_ --samples 9
redo 'stale records in its first part' old.exr -o again.exr --layout multipart --prefix y_ --samples 10

# Content of the other files: mesh, material, proxies of a frame, OpenColorIO config, shaders.
oiiotool "$here/samples/box.exr" --cut 40x32+200+120 --origin +0+0 --fullpixels -o box.exr || die oiiotool
sed 's/^mtllib.*/mtllib m.mtl/' "$here/samples/box.obj" >m.obj
cp "$here/samples/box.mtl" m.mtl
ray="box.exr $o --method raytrace --mesh m.obj --trace gpu"
redo 'a mesh' $ray
awk '/^Kd/ && !n++ { print "Kd 0.1 0.2 0.3"; next } { print }' m.mtl >new.mtl && mv new.mtl m.mtl
redo 'another material' $ray
printf 'ocio_profile_version: 1\nroles: {scene_linear: lin}\ndisplays: {d: [!<View> {name: v, colorspace: lin}]}\nactive_displays: []\nactive_views: []\ncolorspaces:\n  - !<ColorSpace>\n    name: lin\n  - !<ColorSpace>\n    name: c\n    to_reference: !<ExponentTransform> {value: [2, 2, 2, 1]}\n' >c.ocio
redo 'an OpenColorIO config' in.exr $o --ocio c.ocio --albedo-colorspace c
sed -i 's/\[2, 2, 2, 1\]/[2, 2, 2.5, 1]/' c.ocio
redo 'another OpenColorIO config' in.exr $o --ocio c.ocio --albedo-colorspace c
sed -i 's/!<ExponentTransform>.*/!<FileTransform> {src: t.spi1d}/' c.ocio
table() { printf 'Version 1\nFrom 0.0 1.0\nLength 2\nComponents 1\n{\n0.0\n%s\n}\n' "$1" >t.spi1d; }
table 0.5
redo 'a look-up table' in.exr $o --ocio c.ocio --albedo-colorspace c
table 0.6
redo 'another look-up table' in.exr $o --ocio c.ocio --albedo-colorspace c
sky=$here/samples/sky_soft.exr
cp "$here/samples/box.exr" also.exr
redo 'a further G-buffer' box.exr $o --env "$sky" --also also.exr
cp "$here/samples/horizon.exr" also.exr
redo 'another further G-buffer' box.exr $o --env "$sky" --also also.exr
cp -r "$here/shaders" shaders
SSDO_SHADER_DIR=$dir/shaders
export SSDO_SHADER_DIR
redo 'shaders from a folder' in.exr $o
grep -q 'SSDO_SHADER_DIR is set' log || die "no warning of SSDO_SHADER_DIR"
exrheader out.exr | grep -q 'ssdo/args.*SSDO_SHADER_DIR=shaders' || exrheader out.exr | grep -q 'SSDO_SHADER_DIR=shaders' || die "the record does not name SSDO_SHADER_DIR"
sed -i '$ s/$/\n#define NEW 1/' shaders/composite.comp
redo 'another shader' in.exr $o
unset SSDO_SHADER_DIR
SSDO_TILE=64
export SSDO_TILE
redo SSDO_TILE in.exr $o
unset SSDO_TILE

# Every variable that the program asks for is in the table.
cat "$here"/src/*/*.c | grep -o 'getenv("SSDO_[A-Z_]*")' >log
[ -s log ] && die "asked for past the table of base/knobs.c"
for v in $(cat "$here"/src/*/*.c | grep -o 'knob_value("SSDO_[A-Z_]*")' | grep -o 'SSDO_[A-Z_]*' | sort -u); do
    grep -q "\"$v\"" "$here/src/base/knobs.c" || die "$v is not in the table"
done

# An output that another program has cropped, stripped or compressed otherwise.
redo 'a plain frame' in.exr $o
oiiotool out.exr --cut 30x20+0+0 -o cut.exr && cp cut.exr out.exr || die oiiotool
redo 'a cropped output' in.exr $o
oiiotool out.exr --ch ViewLayer.Combined.R,ViewLayer.Combined.G,ViewLayer.Combined.B -o less.exr && cp less.exr out.exr || die oiiotool
redo 'an output without layers' in.exr $o
oiiotool out.exr --compression piz -o piz.exr && cp piz.exr out.exr || die oiiotool
redo 'an output of another compression' in.exr $o
head -c 20000 out.exr >short.exr && cp short.exr out.exr
redo 'a cut output' in.exr $o

# Previews and reports are part of what is done.
redo 'a report' in.exr $o --report r.json
redo 'a preview' in.exr $o --preview p.png --report r.json
for f in p.png r.json; do
    rm $f
    redo "a lost $f" in.exr $o --preview p.png --report r.json
    head -c 300 $f >cut && mv cut $f
    redo "a cut $f" in.exr $o --preview p.png --report r.json
done
cp p.png mine.png && cp r.json mine.json
redo 'another frame' other.exr -o out2.exr --preview p.png --report r.json
redo "another frame's preview" in.exr $o --preview p.png --report mine.json
redo "another frame's report" in.exr $o --preview mine.png --report r.json

# A sequence: a file of proxies a frame; the frames that it does not concern stay.
mkdir seq && cp in.exr seq/f.0001.exr && cp other.exr seq/f.0002.exr
for i in 1 2; do echo '{"spheres": [{"centre": [0, 0, 0], "radius": 0.3}]}' >seq/p.000$i.json; done
many="seq/f.####.exr -o seq/o.####.exr --proxies seq/p.####.json --preview seq/o.####.png --preview-every 2"
run $many
run $many
[ "$(grep -c 'skipped, already done' log)" = 2 ] || die "a sequence is made twice"
echo '{"spheres": [{"centre": [0, 0, 0], "radius": 0.31}]}' >seq/p.0002.json
run $many
[ "$(grep skipped log)" = 'frame 1 (1 of 2): skipped, already done' ] || die "other proxies of frame 2"
rm seq/o.0002.png
run $many
[ "$(grep skipped log)" = 'frame 1 (1 of 2): skipped, already done' ] || die "a lost preview of frame 2"

# A change that the samples miss: --skip-existing=exact does not.
oiiotool "$here/samples/still.exr" --fullpixels --resize 640x400 --compression none -o big.exr || die oiiotool
[ "$(stat -c %s big.exr)" -gt 6000000 ] || die "the large input is small"
redo 'a large input' big.exr -o big-out.exr --layers occlusion
exact() { "$SSDO" --samples 4 big.exr -o big-out.exr --layers occlusion --skip-existing=exact >log 2>&1 || die "exact"; }
exact
grep -q skipped log && die "exact: nobody has looked at all bytes yet"
exact
grep -q skipped log || die "exact: made twice"
kept 'a run by samples after an exact one' big.exr -o big-out.exr --layers occlusion
printf '\001' | dd of=big.exr bs=1 seek=$(($(stat -c %s big.exr) / 2 + 9000)) conv=notrunc 2>/dev/null || die dd
exact
grep -q skipped log && die "exact: a changed byte was missed"

# Same input and options, same bytes: whatever the folder, the name of the input and the time.
"$SSDO" -q --samples 4 in.exr -o one.exr && mkdir far && cp in.exr far/x.exr && "$SSDO" -q --samples 4 far/x.exr -o far/two.exr || die "two"
cmp one.exr far/two.exr || die "time, path or name enter the file"
echo "figure: $tried changes, each made again once; nothing made again without one"
