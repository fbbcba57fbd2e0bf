#!/bin/sh
# One source, two ways of reading pictures and two of storing them: on one device they give the same bytes. And where nothing is blocked
# the occlusion is 1 by construction: also where a division may be wrong by a rounding, as GL allows and some drivers do.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
here=$(cd "$(dirname "$0")/../.." && pwd)
all=occlusion,radiance,indirect,composite,visibility

same() { # NAME, then options: the outputs of both ways of reading
    name=$1
    shift
    for read in image texture; do SSDO_READ=$read "$SSDO" -q "$@" -o "$work/$name.$read.exr" 2>"$work/log" || { cat "$work/log"; exit 1; }; done
    cmp "$work/$name.image.exr" "$work/$name.texture.exr" || { echo "$name: the ways of reading differ"; exit 1; }
}
# The middle of two samples: no multiple of a tile or a group of threads.
ortho=$work/ortho.exr
still=$work/still.exr
for s in ortho still; do oiiotool "$here/samples/$s.exr" --cut 235x133+120+70 --origin +0+0 --fullpixels -o "$work/$s.exr" >/dev/null; done
same arc "$ortho" --env "$here/samples/sky_sun.exr" --layers $all,bent --samples 32
same error "$still" --env "$here/samples/sky_soft.exr" --layers occlusion,error,bent --error 0.05
same half "$still" --env "$here/samples/sky_sun.exr" --quality draft --layers $all,depthmask,diffuse
same s3ho "$ortho" --method s3ho --sh-bands 3 --env "$here/samples/sky_soft.exr" --layers occlusion,radiance,visibility,sh_0,sh_3 \
    --proxies "$here/samples/proxies/ortho.json"
same vpl "$still" --method ssdo --bounce vpl --env "$here/samples/sky_soft.exr" --samples 16
for m in gtao bitmask hbao alchemy hemisphere; do same $m "$ortho" --method $m --samples 16 --layers occlusion,composite; done
same raytrace "$here/samples/box.exr" --method raytrace --mesh "$here/samples/box.obj" --trace gpu --samples 1 \
    --env "$here/samples/sky_sun.exr" --layers $all

# Dispatched instead of drawn: the same but for denormals, which drawing may flush; half layers hold none of those.
for draw in 0 1; do
    SSDO_DRAW=$draw "$SSDO" -q "$still" -o "$work/draw$draw.exr" --env "$here/samples/sky_soft.exr" --quality draft --layers $all
    SSDO_DRAW=$draw "$SSDO" -q "$still" -o "$work/error$draw.exr" --error 0.05 --layers occlusion,error
done
compare=$(dirname "$SSDO")/tests/gpu/compare # pixels: the header names SSDO_DRAW
for f in draw error; do "$compare" "$work/${f}0.exr" "$work/${f}1.exr" 0 || { echo "drawn and dispatched differ"; exit 1; }; done
