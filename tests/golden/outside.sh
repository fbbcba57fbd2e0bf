#!/bin/sh
# What lies outside the frame: a roof closes it, one decision for a sequence; further G-buffers are read or refused in words.
set -e
die() { echo "FAILED: $*"; exit 1; }
here=$(pwd)
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
covered=$here/samples/covered sky="--env $here/samples/sky_sun.exr" fast="--samples 8 --layers radiance --keep none"
says() { "$SSDO" -v "$@" 2>&1 >/dev/null | sed -n 's/.*outside: \([0-9.]*\) of.*/\1/p'; }

[ "$(says "$covered/room.exr" -o o.exr $sky $fast)" = 0.08 ] || die "a room with its ceiling in view is not closed"
[ "$(says "$here/samples/box.exr" -o o.exr $sky $fast)" = 1 ] || die "an open box whose lid is seen to end is closed"
[ "$(says "$here/samples/horizon.exr" -o o.exr $sky $fast)" = 1 ] || die "a landscape is closed"

# One decision for a sequence, by its lowest frame, whichever frames a task makes.
cp "$covered/room.exr" f.0001.exr
cp "$covered/corner.exr" f.0002.exr
"$SSDO" -q f.####.exr -o a.####.exr $sky $fast || die "a sequence"
"$SSDO" -q f.####.exr -o b.####.exr --frames 2 $sky $fast || die "one frame of it"
"$SSDO" -q "$covered/corner.exr" -o alone.exr $sky $fast || die "the frame alone"
cmp a.0002.exr b.0002.exr || die "another task decides otherwise"
oiiotool a.0002.exr alone.exr --diff >/dev/null && die "the frame decides for itself"

# Further G-buffers.
"$SSDO" -q "$covered/room.exr" -o o.exr $sky $fast --also "$covered/room.exr" || die "the frame's own G-buffer as a further one"
refused() { # CODE TEXT ARGS
    code=$1 text=$2
    shift 2
    got=0
    rm -f o.exr
    "$SSDO" -q "$@" -o o.exr $sky $fast 2>err || got=$?
    [ "$got" = "$code" ] || die "$*: exit $got, not $code: $(cat err)"
    grep -q -e "$text" err || die "$*: $(cat err)"
    [ ! -e o.exr ] || die "$*: an output was written"
}
oiiotool "$covered/room.exr" --ch ViewLayer.Depth.Z,ViewLayer.Normal.X,ViewLayer.Normal.Y,ViewLayer.Normal.Z -o flat.exr
refused 3 'flat.exr.*position' "$covered/room.exr" --also flat.exr
refused 3 'nowhere.exr' "$covered/room.exr" --also nowhere.exr
refused 3 'also is in world space' "$here/samples/ortho.exr" --also "$covered/room.exr"
echo "figure: 3 places told apart, 1 decision for 2 tasks, 3 further G-buffers refused"
