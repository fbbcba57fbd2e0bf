#!/bin/sh
# The library as it is installed: both examples build and run against nothing else and write the program's bytes, shared and static
# library show ssdo_* only, and the pkg-config file says how to link either.
set -u
build=$(dirname "$SSDO")
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; exit 1; }
make -s BUILD="$build" PREFIX="$dir/usr" install >"$dir/log" 2>&1 || die "make install: $(tail -3 "$dir/log")"
export PKG_CONFIG_PATH="$dir/usr/lib/pkgconfig${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}" SSDO_PLUGIN_DIR="$dir/usr/lib/ssdo-filter"

for library in "nm -D --defined-only $dir/usr/lib/libssdo.so" "nm --defined-only --extern-only $dir/usr/lib/libssdo.a"; do
    shown=$($library | awk 'NF == 3 { print $3 }' | sort)
    [ "$shown" = "$(grep -o 'ssdo_[a-z_]*(' src/ssdo.h | grep -v 'ssdo_context' | tr -d '(' | sort -u)" ] ||
        die "$library shows other names than src/ssdo.h has: $shown"
done

for python in python3 /usr/bin/python3; do "$python" -c 'import numpy' 2>/dev/null && break; done
settings="env=samples/sky_soft.exr samples=4 resolution=half"
options=$(for s in $settings; do printf -- '--%s ' "$s"; done)
# shellcheck disable=SC2086
"$SSDO" -q samples/box.exr -o "$dir/program.exr" $options || die "the program"
warn="-Wall -Wextra -Werror -Wpedantic -std=c11 ${SANFLAGS:-}"
# shellcheck disable=SC2046,SC2086
{
    ${CC:-cc} $warn samples/library/filter.c -o "$dir/shared" $(pkg-config --cflags --libs ssdo) -Wl,-rpath,"$dir/usr/lib" &&
        ${CC:-cc} $warn samples/library/filter.c -o "$dir/static" $(pkg-config --cflags ssdo) "$dir/usr/lib/libssdo.a" \
            $(pkg-config --static --libs ssdo | sed 's/-lssdo//') -Wl,--as-needed \
            $(pkg-config --libs-only-L OpenEXR | sed 's/-L/-Wl,-rpath,/g')
} || die "the example does not build"
ldd "$dir/static" | grep -q libssdo && die "the static example needs the shared library"
# A sanitizer must be loaded first, which Python does not do, and the leaks of drivers are only known to the tests' programs.
under=
[ -z "${SANFLAGS:-}" ] || under="env ASAN_OPTIONS=${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0 LD_PRELOAD=$(${CC:-cc} -print-file-name=libasan.so)"
for example in "$dir/shared" "$dir/static" "env LIBSSDO=$dir/usr/lib/libssdo.so $python samples/library/filter.py"; do
    rm -f "$dir/library.exr"
    # shellcheck disable=SC2086
    said=$($under $example samples/box.exr "$dir/library.exr" $settings 2>"$dir/err") || die "$example: $(cat "$dir/err")"
    case $said in "occlusion 0."*) ;; *) die "$example said: $said" ;; esac
    # The program's file has a digest beside, for --skip-existing; all else must be the same.
    oiiotool --info -v -a "$dir/program.exr" | grep -v 'ssdo/digest\|program.exr' >"$dir/a"
    oiiotool --info -v -a "$dir/library.exr" | grep -v 'ssdo/digest\|library.exr' >"$dir/b"
    diff "$dir/a" "$dir/b" || die "$example: other attributes"
    oiiotool -a "$dir/program.exr" "$dir/library.exr" --diff >/dev/null || die "$example: other pixels"
done
# shellcheck disable=SC2086
LIBSSDO="$dir/usr/lib/libssdo.so" $under "$python" samples/library/filter.py >"$dir/said" 2>&1 || die "arrays: $(cat "$dir/said")"
grep -q '^occlusion 0\.9' "$dir/said" || die "a ball on a floor: $(cat "$dir/said")"
echo "library: two examples, three ways to load it"
