#!/bin/sh
# What makes a start cheap: --version and --help load no driver and no module, and a second run compiles nothing, neither programs
# nor their machine code.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; exit 1; }
heavy='libEGL_|_dri|libLLVM|gallium|OpenImageIO|OpenColorIO|embree|ssdo-'
# The address sanitizer itself needs the C++ library, and from 3.4 on OpenEXR's core library, for HTJ2K.
core=$(ldd "$SSDO" | sed -n 's/.*=> \(.*libOpenEXRCore[^ ]*\) .*/\1/p')
nm -D "$SSDO" | grep -q __asan_init || readelf -d "$core" | grep -q 'NEEDED.*libstdc' || heavy="$heavy|libstdc"
for option in --version --help; do
    LD_DEBUG=files "$SSDO" $option >"$dir/out" 2>"$dir/loaded" || die "$option"
    [ -s "$dir/out" ] || die "$option says nothing"
    grep -q 'calling init.*libdeflate' "$dir/loaded" || die "the loader says nothing"
    loaded=$(sed -n 's/.*calling init: //p' "$dir/loaded" | grep -E "$heavy")
    [ -z "$loaded" ] || die "$option loads $loaded"
done

unset MESA_SHADER_CACHE_DIR MESA_SHADER_CACHE_DISABLE
export XDG_CACHE_HOME="$dir/cache"
oiiotool samples/still.exr --cut 160x90+160+90 --origin +0+0 --fullpixels -o "$dir/in.exr" || die oiiotool
# run N: what was compiled and what came from the cache, of a run that leaves the list of cached files in $dir/files.N.
run() {
    "$SSDO" -q "$dir/in.exr" -o "$dir/out.exr" --env samples/sky_soft.exr --quality draft --report "$dir/report.$1" || die "run $1"
    (cd "$dir/cache" && find . -type f | sort) >"$dir/files.$1"
    tr -d ' \n' <"$dir/report.$1" | sed 's/.*"programs":{"compiled":\([0-9]*\),"from_cache":\([0-9]*\)}.*/\1 \2/'
}
first=$(run 1) second=$(run 2)
count=${first% *}
[ "$count" -gt 5 ] && [ "$first" = "$count 0" ] || die "the first run compiled and found: $first"
[ "$second" = "0 $count" ] || die "the second run compiled and found: $second (the first: $first)"
# Some driver folders hold more than our programs; whatever they hold, a second run has nothing to add.
cmp -s "$dir/files.1" "$dir/files.2" || die "the second run adds to the cache: $(diff "$dir/files.1" "$dir/files.2" | head -5)"
echo "figure: $count programs, $(wc -l <"$dir/files.1") files in the cache; the second run adds none"
