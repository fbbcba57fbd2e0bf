#!/bin/sh
# What lies outside the frame: a roof closes it, the picture's own light says how far, one decision for a sequence; further G-buffers are
# read or refused in words.
set -e
die() { echo "FAILED: $*"; exit 1; }
here=$(pwd)
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
covered=$here/samples/covered sky="--env $here/samples/sky_sun.exr" fast="--samples 8 --layers radiance --keep none"
says() { "$SSDO" -v "$@" 2>&1 >/dev/null | sed -n 's/.*outside: \([0-9.]*\) of.*roof.*/\1/p'; }
fits() { "$SSDO" -v "$@" 2>&1 >/dev/null | sed -n 's/.*outside: \([0-9.]*\) of.*fitted.*/\1/p'; }

[ "$(says "$covered/room.exr" -o o.exr $sky $fast)" = 0.08 ] || die "a room with its ceiling in view is not closed"
[ "$(says "$here/samples/box.exr" -o o.exr $sky $fast)" = 1 ] || die "an open box whose lid is seen to end is closed"
[ "$(says "$here/samples/horizon.exr" -o o.exr $sky $fast)" = 1 ] || die "a landscape is closed"

# A world with z up under plain names, which the program takes for y up: what lies ahead is no roof, and somebody has to say which it is.
for s in box covered/room; do
    oiiotool -i:ch=ViewLayer.Position.X,ViewLayer.Position.Y,ViewLayer.Position.Z,ViewLayer.Normal.X,ViewLayer.Normal.Y,ViewLayer.Normal.Z \
        "$here/samples/$s.exr" --chnames P.X,P.Y,P.Z,N.X,N.Y,N.Z -d float -o plain.exr
    "$SSDO" -v plain.exr -o o.exr $sky $fast 2>log || die "plain names: $(cat log)"
    grep -q 'warning: plain.exr: with y up.*--env-up' log || die "$s: no word on which axis is up"
    ! grep -q 'outside: 0.08' log || die "$s: closed by what lies ahead"
    "$SSDO" -v plain.exr -o o.exr $sky $fast --env-up z >log 2>&1
    ! grep -q 'env-up' log || die "$s: --env-up z is doubted"
done
grep -q 'outside: 0.08' log || die "a room of plain names is not closed with --env-up z"

# The picture's own light: of a room with a roof; of one without, which is dark for this sky; not of an open box.
corner=$covered/corner.exr soft="--env $here/samples/sky_soft.exr"
[ -n "$(fits "$covered/room.exr" -o o.exr $sky $fast)" ] || die "a room's own light tells nothing"
lit=$(fits "$covered/room.exr" -o o.exr $sky --layers radiance --keep none --samples 3 --blur none)
[ "$lit" = "$(fits "$covered/room.exr" -o o.exr $sky --layers radiance,occlusion --keep none --error 0.1)" ] || die "the quality decides what is open"
[ -n "$(fits "$corner" -o o.exr $soft $fast)" ] || die "a dark corner's own light tells nothing"
"$SSDO" "$corner" -o o.exr $soft $fast 2>&1 | grep -q 'warning: .*corner.exr: its own light is 0.0' || die "no warning that the outside was closed"
[ -z "$(fits "$here/samples/box.exr" -o o.exr $soft $fast)" ] || die "an open box is fitted unasked"
[ -n "$(fits "$here/samples/box.exr" -o o.exr $sky $fast --beauty-env "$here/samples/sky_soft.exr")" ] || die "--beauty-env is not used"
"$SSDO" "$corner" -o o.exr $soft $fast --outside open --beauty-env "$here/samples/sky_soft.exr" 2>&1 |
    grep -q 'beauty-env is not used: --outside' || die "--beauty-env is dropped without a word"
# A beauty with albedo says much the same as direct light.
oiiotool -i:ch=ViewLayer.Combined.R,ViewLayer.Combined.G,ViewLayer.Combined.B,ViewLayer.DiffCol.R,ViewLayer.DiffCol.G,ViewLayer.DiffCol.B,\
ViewLayer.Position.X,ViewLayer.Position.Y,ViewLayer.Position.Z,ViewLayer.Normal.X,ViewLayer.Normal.Y,ViewLayer.Normal.Z "$corner" -o beauty.exr
for f in "$corner" beauty.exr; do
    "$SSDO" -q "$f" -o o.exr $soft --beauty-env "$here/samples/sky_soft.exr" --radius 0.5 --samples 16 --layers radiance --keep none
    oiiotool o.exr --stats | sed -n 's/.*Stats Avg: \([0-9.]*\).*/\1/p'
done >means
awk 'NR == 1 { a = $1 } NR == 2 { exit !($1 > 0.6 * a && $1 < 1.5 * a && a < 0.2) }' means || die "light by DiffDir and by beauty: $(cat means)"

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
echo "figure: 3 places told apart, 3 of 4 fitted to their light, 1 decision for 2 tasks, 3 further G-buffers refused"
