#!/bin/sh
# Every program that a pass can ask for declares no more than GL 4.5 promises, used or not. No device and no validator says so:
# llvmpipe allows more, and glslangValidator does not count. The count itself is tried on what it must refuse.
set -eu
here=$(dirname "$0")/../limits
build=$(dirname "$SSDO")
count() { sed '/^#line/d' | gcc -E -P -w -undef -x c - | awk -f "$here/count.awk"; }

"$build/tests/list_variants" stream 2>/dev/null | count

refuses() { # WHAT, a shader on standard input
    if { echo '@variant trial'; cat; } | count >"$build/tests/limits.log"; then
        echo "limits: $1 was not refused"
        exit 1
    fi
    grep -q "$1" "$build/tests/limits.log" || { echo "limits: refused, but not for $1:"; cat "$build/tests/limits.log"; exit 1; }
}
for i in 1 2 3 4 5 6 7 8 9; do echo "layout(r32f) readonly uniform image2D image$i;"; done | refuses '9 images'
for i in 1 2 3 4 5; do echo "layout(r32f) uniform image2D image$i;"; echo "layout(std430) buffer Block$i { int v$i[]; };"; done |
    refuses '10 images, storage blocks and outputs together'
echo 'layout(std430, binding = 40) buffer Block { int v[]; };' | refuses '40 as a binding'
printf 'layout(std140, binding = 1) uniform Block {\n    vec4 v[4096];\n};\n' | refuses '65536 bytes of a uniform block'
for i in $(seq 17); do echo "uniform sampler2D picture$i;"; done | refuses '17 samplers'
echo 'shared vec4 parts[2049];' | refuses 'bytes of shared memory'
