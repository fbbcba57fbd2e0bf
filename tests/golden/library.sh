#!/bin/sh
# An OpenEXR library of another minor version than the headers is refused in words, before any file is opened; another patch is not.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; exit 1; }
# The library that says it is VERSION, in front of the real one.
other() {
    echo "void exr_get_library_version(int *a, int *b, int *c, const char **x); void exr_get_library_version(int *a, int *b, int *c,
        const char **x) { *a = $1, *b = $2, *c = $3, *x = \"\"; }" >"$dir/other.c"
    ${CC:-cc} -shared -fPIC -o "$dir/other.so" "$dir/other.c" || die "no compiler"
}
built=$(pkg-config --modversion OpenEXR)
major=${built%%.*} minor=${built#*.} minor=${minor%%.*}
for command in "-o $dir/out.exr" --explain; do
    other "$major" $((minor + 1)) 7
    LD_PRELOAD="$dir/other.so" "$SSDO" samples/still.exr $command >"$dir/said" 2>&1
    code=$?
    [ $code = 3 ] || die "$command: exit $code instead of 3: $(cat "$dir/said")"
    grep -q "libOpenEXRCore.*is OpenEXR $major.$((minor + 1)).7, .* built for OpenEXR $major.$minor;" "$dir/said" || die "$(cat "$dir/said")"
    [ ! -e "$dir/out.exr" ] || die "an output is there"
    other "$major" "$minor" 99
    LD_PRELOAD="$dir/other.so" "$SSDO" samples/still.exr $command --samples 4 >"$dir/said" 2>&1 || die "another patch: $(cat "$dir/said")"
    rm -f "$dir/out.exr"
done
