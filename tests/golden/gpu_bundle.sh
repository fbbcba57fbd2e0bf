#!/bin/sh
# The archive for machines with a GPU (tests/gpu) runs away from the tree, and its short form passes on this device. `make gpu-bundle`
# makes all of it and holds it to its size.
set -eu
build=$(dirname "$SSDO")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/made" "$work/there"
sh tests/gpu/make.sh "$build" "$work/made"
tar -C "$work/there" -xf "$work/made/gpu-bundle.tar.xz"
rm -rf "$work/made"
code=0
env -i PATH="$PATH" sh "$work/there/gpu-bundle/run.sh" "$work/out" >"$work/log" 2>&1 || code=$?
tail -30 "$work/log"
[ "$code" = 0 ] && [ "$(wc -c <"$work/out/table.md")" -le 12000 ]
