#!/bin/sh
# shot.sh FOLDER: small files to try the README's commands on, cut out of samples/still.exr with oiiotool (openimageio-tools):
# shot.0001.exr to shot.0012.exr, a camera that pans; the passes of its first frame as files of their own, shot_P.0001.exr ...;
# depth.exr, which holds nothing but depth.
set -eu
[ $# = 1 ] || { echo "usage: sh samples/shot.sh FOLDER" >&2; exit 2; }
samples=$(dirname "$0") to=$1 V=ViewLayer
command -v oiiotool >/dev/null || { echo "shot.sh: oiiotool is missing; install Debian's openimageio-tools" >&2; exit 1; }
mkdir -p "$to"
set -- "$samples/still.exr" --label all
for i in 01 02 03 04 05 06 07 08 09 10 11 12; do
    set -- "$@" all --cut "128x96+$((60 + 12 * ${i#0}))+90" --origin +0+0 --fullpixels -o "$to/shot.00$i.exr" --pop
done
oiiotool "$@" all --ch Z=$V.Depth.Z --eraseattrib '.*' -o "$to/depth.exr"
set -- "$to/shot.0001.exr" --label one
for pass in P:R=$V.Position.X,G=$V.Position.Y,B=$V.Position.Z N:X=$V.Normal.X,Y=$V.Normal.Y,Z=$V.Normal.Z Z:Z=$V.Depth.Z \
    albedo:R=$V.DiffCol.R,G=$V.DiffCol.G,B=$V.DiffCol.B; do
    set -- "$@" one --ch "${pass#*:}" --eraseattrib '.*' -o "$to/shot_${pass%%:*}.0001.exr" --pop
done
oiiotool "$@"
