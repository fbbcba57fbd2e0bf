#!/bin/sh
# meshes.sh DIR VARIANT: writes the meshes of the rendered scenes (NAME.obj, NAME.mtl) and the spheres for what stands beside the
# middle of their pictures (proxies/NAME.json) into DIR with samples/render.py, unless these very scripts have done so before.
set -eu
made=$(cat samples/render.py samples/scenes/*.py | cksum)
[ "$(cat "$1/exported" 2>/dev/null)" = "$made" ] && exit 0
mkdir -p "$1"
cp -n samples/sky_*.exr "$1" # or the script would make them
blender -b --factory-startup -P samples/render.py -- --all --out "$1" --variant "$2" --export-obj --export-proxies >"$1/export.log"
echo "$made" >"$1/exported"
