#!/bin/sh
# pictures.sh BINARY: makes the README's pictures in samples/pictures/ from the samples. Needs oiiotool.
set -eu
bin=$1
out=samples/pictures
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
mkdir -p "$out"
encode='--mulc 1.0,1.0,1.0 --powc 0.4545 --clamp:min=0:max=1'

# sheet SCENE SKY RADIUS: the layers, and an edge crop of our composite beside Blender's own picture.
sheet() {
    "$bin" -q samples/$1.exr -o "$tmp/$1.exr" --env samples/$2 --radius $3 --preview "$out/$1.png"
    box=$4
    for which in composite ViewLayer.Combined; do
        oiiotool "$tmp/$1.exr" --ch R=$which.R,G=$which.G,B=$which.B --cut "$box" --resample 480x0 $encode -d uint8 -o "$tmp/$which.png"
    done
    oiiotool "$tmp/composite.png" "$tmp/ViewLayer.Combined.png" --mosaic:pad=6 2x1 -o "$out/$1-edges.png"
}

sheet still sky_soft.exr 0.5 96x54+80+20
sheet horizon sky_sun.exr 2 96x54+90+60

# The bounce in the open box: arc, vpl, raytrace, and Cycles (the mean of its two renders).
indirect() {
    "$bin" -q samples/box.exr -o "$tmp/box.exr" --env samples/sky_soft.exr --radius 0.6 --layers indirect "$@"
    oiiotool "$tmp/box.exr" --ch indirect.R,indirect.G,indirect.B -o "$tmp/panel.exr"
}
panel() { oiiotool "$tmp/panel.exr" --cut 404x254+38+6 --resize 303x0 --mulc 4 $encode -d uint8 -o "$tmp/$1.png"; }
indirect --method arc && panel 1
indirect --method arc --bounce vpl && panel 2
indirect --method raytrace --mesh samples/box.obj --samples 256 && panel 3
oiiotool samples/box.exr --ch ViewLayer.DiffInd.R,ViewLayer.DiffInd.G,ViewLayer.DiffInd.B samples/box_truth.exr \
    --ch DiffInd.R,DiffInd.G,DiffInd.B --add --mulc 0.5 -o "$tmp/panel.exr" && panel 4
oiiotool "$tmp/1.png" "$tmp/2.png" "$tmp/3.png" "$tmp/4.png" --mosaic:pad=6 2x2 -o "$out/box-bounce.png"

# The middle third of the open box, whose walls are then out of sight: alone, with the walls as spheres, and Cycles' whole box.
oiiotool samples/box.exr --cut 160x250+160+8 --origin +0+0 --fullpixels -o "$tmp/middle.exr"
third() { # NUMBER LAYER-IN-FILE BRIGHTNESS FILE
    oiiotool "$4" --ch "$2.R,$2.G,$2.B" --cut 160x170+0+60 --mulc "$3" $encode -d uint8 -o "$tmp/third$1.png"
}
filter_middle() { "$bin" -q "$tmp/middle.exr" -o "$tmp/$1.exr" --keep none --env samples/sky_soft.exr --radius 0.6 --layers radiance,indirect $2; }
filter_middle alone ''
filter_middle spheres '--proxies samples/proxies/box.json'
third 1 radiance 1 "$tmp/alone.exr" && third 2 radiance 1 "$tmp/spheres.exr" && third 3 ViewLayer.DiffDir 1 "$tmp/middle.exr"
third 4 indirect 4 "$tmp/alone.exr" && third 5 indirect 4 "$tmp/spheres.exr" && third 6 ViewLayer.DiffInd 4 "$tmp/middle.exr"
oiiotool "$tmp"/third1.png "$tmp"/third2.png "$tmp"/third3.png "$tmp"/third4.png "$tmp"/third5.png "$tmp"/third6.png \
    --mosaic:pad=6 6x1 -o "$out/proxies.png"
