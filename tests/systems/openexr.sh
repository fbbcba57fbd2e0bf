#!/bin/sh
# openexr.sh FOLDER...: this tree built against several versions of OpenEXR, each a folder of its sources or of an installed one (with
# lib/pkgconfig); the oldest first. All test_exr_* and the golden scripts against each, and at the end a table of what reads which
# compression, as src/exr/README.md has it. Files come from the tools of the last folder. GOLDEN=: the table and the unit tests alone.
set -u
out=$PWD/build/openexr failed=0
mkdir -p "$out/alone"
[ $# -gt 0 ] || { echo "which? make check-openexr VERSIONS='openexr-3.1.5 openexr-3.4.15'" >&2; exit 2; }

# The core library and the tools that tests call; Imath is the machine's, or what CMAKE_PREFIX_PATH names.
build() {
    cmake -S "$1" -B "$2-build" -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$2" -DCMAKE_INSTALL_LIBDIR=lib -DBUILD_TESTING=OFF \
        -DBUILD_WEBSITE=OFF -DOPENEXR_BUILD_EXAMPLES=OFF -DOPENEXR_INSTALL_EXAMPLES=OFF -DOPENEXR_INSTALL_DOCS=OFF >"$2.log" 2>&1 &&
        cmake --build "$2-build" -j "$(nproc)" --target install >>"$2.log" 2>&1 || { tail -5 "$2.log" >&2; return 1; }
}

# with PREFIX COMMAND...: what it starts finds that OpenEXR first, headers, library and tools.
with() {
    prefix=$1
    shift
    PKG_CONFIG_PATH=$prefix/lib/pkgconfig PATH=$prefix/bin:$PATH "$@"
}

prefixes=
for folder in "$@"; do
    prefix=$(cd "$folder" && pwd) || exit 2
    if [ ! -e "$prefix/lib/pkgconfig/OpenEXR.pc" ]; then
        [ -e "$out/$(basename "$prefix")/lib/pkgconfig/OpenEXR.pc" ] || build "$prefix" "$out/$(basename "$prefix")" || exit 1
        prefix=$out/$(basename "$prefix")
    fi
    prefixes="$prefixes $prefix"
done
for prefix in $prefixes; do
    version=$(with "$prefix" pkg-config --modversion OpenEXR)
    tree=$out/tree-$version
    tests=$(ls tests/unit/test_exr_*.c | sed "s|tests/unit/\(.*\)\.c|$tree/tests/\1|")
    # The installed folder of modules is one that does not exist, so that only those beside the program are found.
    with "$prefix" make --no-print-directory -j "$(nproc)" BUILD="$tree" PREFIX=/nonexistent all unit >"$tree.log" 2>&1 ||
        { echo "FAILED $version: it does not build: $(grep -m 1 error "$tree.log")"; failed=1; continue; }
    if with "$prefix" env SSDO_SCRIPTS="${GOLDEN-tests/golden/*.sh}" sh tests/run.sh "$tree" $tests >"$tree.log" 2>&1; then said=ok; else said=FAILED failed=1; fi
    echo "$said $version: $(tail -n 1 "$tree.log")"
    grep '^FAILED' "$tree.log"
done

# The table: a row for each compression that the last version's tool writes, a column for each version.
tools=$prefix/bin
table=$out/table.md
{
    printf '| compression |'; for p in $prefixes; do printf ' %s |' "$(with "$p" pkg-config --modversion OpenEXR)"; done; echo
    printf '| --- |'; for p in $prefixes; do printf ' --- |'; done; echo
} >"$table"
filter() { "$1/ssdo-filter" -q "$2" -o "$3" --layers occlusion --keep none --samples 4 --compression none; }
for codec in none rle zips zip piz pxr24 b44 b44a dwaa dwab htj2k256 htj2k32; do
    "$tools/exrmaketiled" -z "$codec" samples/box.exr "$out/packed.exr" 2>/dev/null || continue
    "$tools/exrmaketiled" -z none "$out/packed.exr" "$out/plain.exr" || exit 1
    printf '| %s |' "$codec" >>"$table"
    for p in $prefixes; do
        tree=$out/tree-$(with "$p" pkg-config --modversion OpenEXR)
        cp "$tree/ssdo-filter" "$out/alone/"
        filter "$tree" "$out/plain.exr" "$out/want.exr" || failed=1
        if filter "$out/alone" "$out/packed.exr" "$out/got.exr" 2>/dev/null; then by='OpenEXR'
        elif filter "$tree" "$out/packed.exr" "$out/got.exr" 2>"$out/said"; then by='the module'
        elif grep -q 'method number [0-9]' "$out/said"; then by="refused, as number $(sed -n 's/.*method number \([0-9]*\).*/\1/p' "$out/said")"
        else by="FAILED: $(tail -n 1 "$out/said")" failed=1; fi
        case $by in OpenEXR | 'the module') oiiotool "$out/got.exr" "$out/want.exr" --diff >/dev/null || { by="$by, WRONG"; failed=1; } ;; esac
        printf ' %s |' "$by" >>"$table"
        rm -f "$out/got.exr" "$out/want.exr"
    done
    echo >>"$table"
done
cat "$table"
exit $failed
