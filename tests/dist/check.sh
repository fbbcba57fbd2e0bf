#!/bin/sh
# check.sh ARCHIVE SUITE...: the archive in fresh roots of Debian releases that have Mesa's driver packages and nothing else of ours,
# unpacked and run by an ordinary user without HOME.
set -u
. tests/systems/root.sh
root_here || exit 77
archive=$1 folder=$(mktemp -d) failed=0
shift
name=$(basename "$archive" .tar.xz)
trap 'root_leave "$folder/root"; rm -rf "$folder/inputs"; rmdir "$folder"' EXIT
trap 'exit 130' INT TERM
# Inputs that need every module: DWA, HDR and PNG environments, a mesh.
mkdir "$folder/inputs"
cp samples/still.exr samples/box.exr samples/box.obj samples/box.mtl samples/sky_soft.exr "$folder/inputs"
oiiotool samples/still.exr --compression dwaa -o "$folder/inputs/dwa.exr" || exit 1
oiiotool samples/sky_soft.exr --ch R,G,B -o "$folder/inputs/sky.hdr" --clamp:min=0:max=1 -d uint8 -o "$folder/inputs/sky.png" || exit 1

cat >"$folder/inputs/config.ocio" <<'C'
ocio_profile_version: 2
roles: {scene_linear: linear, default: linear}
file_rules: [!<Rule> {name: Default, colorspace: linear}]
displays: {screen: [!<View> {name: plain, colorspace: linear}]}
colorspaces:
  - !<ColorSpace> {name: linear}
  - !<ColorSpace> {name: halved, to_scene_reference: !<MatrixTransform> {matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}}
C

# try NAME ARGUMENT...: one run, which must leave out.exr.
try() {
    what=$1
    shift
    if root_run "$root" 1000:1000 "cd /tmp/work && rm -f out.exr && ./$name/bin/ssdo-filter $* -o out.exr && test -s out.exr" >"$folder/log" 2>&1; then
        echo "ok $suite: $what"
    else
        failed=1
        echo "FAILED $suite: $what: $(tail -n 3 "$folder/log")"
    fi
    rm -f "$folder/log"
}
for suite in "$@"; do
    root=$folder/root
    root_make "$suite" "$root" libegl1 libegl-mesa0 libgl1-mesa-dri libopengl0 xz-utils || { echo "FAILED $suite: debootstrap"; failed=1; continue; }
    mkdir -p "$root/tmp/work" && cp "$archive" "$root/tmp/work/a.tar.xz" && cp "$folder"/inputs/* "$root/tmp/work" && chown -R 1000:1000 "$root/tmp/work"
    root_run "$root" 1000:1000 'cd /tmp/work && tar xf a.tar.xz' || { echo "FAILED $suite: unpacking"; failed=1; continue; }
    try "make demo's command" still.exr --env sky_soft.exr --preview layers.png -v
    try "DWA input" -q dwa.exr --samples 8
    try "HDR environment" -q still.exr --env sky.hdr --samples 8
    try "PNG environment" -q still.exr --env sky.png --samples 8
    try "Embree" -q box.exr --method raytrace --mesh box.obj --trace embree --samples 4
    [ -e "$root/tmp/work/$name/lib/ssdo-filter/ssdo-colour.so" ] || { echo "left out: colour space"; root_leave "$root"; continue; }
    try "colour space" -q still.exr --env sky.hdr --env-colorspace halved --ocio config.ocio --samples 8
    root_leave "$root"
done
exit $failed
