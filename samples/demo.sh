#!/bin/sh
# demo.sh BINARY BUILD: filters a sample the way the README shows it and says where to look. Called by `make demo`.
set -eu
bin=$1
mkdir -p demo
"$bin" samples/still.exr -o demo/out.exr --env samples/sky_soft.exr --preview demo/layers.png -v
echo
echo "demo/out.exr     the input's channels with occlusion, radiance, indirect and composite beside them"
echo "demo/layers.png  the four layers to look at"
