#!/bin/sh
# make.sh BUILD VERSION: BUILD/ssdo-filter-VERSION-linux-x86_64.tar.xz, which runs where it is unpacked: program, modules, the
# libraries they need (tests/dist/libraries.sh) with their licences, manual and completions.
set -eu
build=$1 name=ssdo-filter-$2-linux-$(uname -m)
command -v patchelf >/dev/null 2>&1 || { echo "dist: needs patchelf" >&2; exit 1; }
stage=$build/dist/$name
rm -rf "$build/dist" && mkdir -p "$stage"
make --no-print-directory install BUILD="$build" DESTDIR="$stage" PREFIX= >/dev/null
program=$stage/bin/ssdo-filter modules=$stage/lib/ssdo-filter libs=$stage/lib/ssdo-filter/libs
sh tests/dist/libraries.sh "$libs" "$program" "$modules"/*.so
# A libepoxy before 1.5.10 opens libGL and asks it for a GLX context, which a machine without a display may lack: this one stands
# before libOpenGL, which has all the rest, and knows of no such context.
if pkg-config --max-version=1.5.9 epoxy; then
    echo 'void *glXGetCurrentContext(void); void *glXGetCurrentContext(void) { return 0; }' >"$build/libgl.c"
    ${CC:-gcc} -shared -fPIC -o "$libs/libGL.so.1" -Wl,-soname,libGL.so.1 "$build/libgl.c" -Wl,--no-as-needed -lOpenGL
fi
strip --strip-unneeded "$program" "$modules"/*.so
patchelf --set-rpath '$ORIGIN/../lib/ssdo-filter/libs' "$program"
for m in "$modules"/*.so; do patchelf --set-rpath '$ORIGIN/libs' "$m"; done
cp LICENSE CHANGELOG.md "$stage/share/doc/ssdo-filter"

# Licences of what travels along: those of the packages that the libraries come from, and the files in $LICENCES for the others.
licences=$stage/share/doc/ssdo-filter/licences
mkdir -p "$licences"
[ -z "${LICENCES-}" ] || cp "$LICENCES"/* "$licences"
for lib in "$libs"/*; do
    found=$(dpkg -S "*/$(basename "$lib")" 2>/dev/null | head -1 || true)
    package=${found%%:*}
    if [ -n "$package" ] && [ -e "/usr/share/doc/$package/copyright" ]; then
        cp -L "/usr/share/doc/$package/copyright" "$licences/$package"
    elif ! ls "$licences" | grep -qi "$(basename "$lib" | sed 's/^lib//; s/Core.*//; s/[-.].*//')"; then
        echo "dist: no licence found for $(basename "$lib")" >&2
    fi
done

# The newest versions of the C and C++ libraries' symbols decide where it runs.
newest() { objdump -T "$program" "$modules"/*.so "$libs"/* 2>/dev/null | grep -o "$1_[0-9][0-9.]*" | sort -uV | tail -1; }
who() { for f in "$program" "$modules"/*.so "$libs"/*; do objdump -T "$f" 2>/dev/null | grep -q "$1[^0-9.]" && basename "$f"; done | tr '\n' ' '; }
c=$(newest GLIBC) cxx=$(newest GLIBCXX)
{
    echo "Needs of the machine: a glibc with $c, a libstdc++ with $cxx, libEGL (glvnd), a driver; see README.md."
    echo "$c is needed by: $(who "$c")"
    for m in images colour trace; do
        [ -e "$modules/ssdo-$m.so" ] || echo "Left out, for want of its library where this was built: the module ssdo-$m.so."
    done
    echo "The program alone needs $(objdump -T "$program" | grep -o 'GLIBC_[0-9.]*' | sort -uV | tail -1)."
} | tee "$stage/share/doc/ssdo-filter/NEEDS"
{
    echo 'Symbols newer than glibc 2.28 and libstdc++ 3.4.25:'
    sh tests/dist/symbols.sh "$stage"
} >>"$stage/share/doc/ssdo-filter/NEEDS"
archive=$build/$name.tar.xz
tar -C "$build/dist" --sort=name --owner=0 --group=0 -c "$name" | xz -T2 -"${XZ_LEVEL:-6}" >"$archive.tmp"
mv "$archive.tmp" "$archive"
echo "dist: $archive, $(($(stat -c %s "$archive") / 1000000)) MB, $(ls "$libs" | wc -l) libraries"
