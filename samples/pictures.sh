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
