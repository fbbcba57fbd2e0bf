#!/bin/sh
# valgrind.sh BUILD: one frame under valgrind's memcheck: no invalid access, no use of what was never set, by the program,
# its libraries or the driver (valgrind.supp: but for the loader).
set -u
command -v valgrind >/dev/null 2>&1 || { echo "no valgrind here"; exit 77; }
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
oiiotool samples/still.exr --cut 48x32+200+120 --origin +0+0 --fullpixels -o "$dir/in.exr" >/dev/null || exit 1
valgrind -q --error-exitcode=66 --num-callers=40 --suppressions="$(dirname "$0")/valgrind.supp" "$1/ssdo-filter" -q "$dir/in.exr" -o "$dir/out.exr" \
    --samples 4 --threads 2 --env samples/sky_soft.exr --report "$dir/r.json" >"$dir/log" 2>&1
code=$?
[ $code = 0 ] && [ -s "$dir/out.exr" ] || { head -80 "$dir/log"; echo "FAILED: exit $code"; exit 1; }
echo "figure: valgrind: one frame, 0 errors"
