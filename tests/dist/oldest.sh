#!/bin/sh
# oldest.sh VERSION OPENEXR IMATH: the archive, built in a fresh Debian 11 (glibc 2.31, gcc 10), so that it runs there and on all that is
# newer: build/oldest/ssdo-filter-VERSION-linux-x86_64.tar.xz; then tried in Debian 11, 12 and 13 (check.sh). OPENEXR and IMATH are
# folders with the sources of OpenEXR 3.1 or later and of Imath 3, which Debian 11 does not have; its OpenColorIO 1 is too old, so the
# module for colour spaces is left out.
set -eu
. tests/systems/root.sh
root_here || exit 77
version=$1 openexr=$2 imath=$3 folder=$(mktemp -d) out=$PWD/build/oldest
[ -e "$openexr/CMakeLists.txt" ] && [ -e "$imath/CMakeLists.txt" ] || {
    echo "dist-oldest: OPENEXR=folder IMATH=folder: where are the sources of OpenEXR and Imath?" >&2
    exit 2
}
mkdir -p "$out"
root=$folder/root
trap 'root_leave "$root"; rmdir "$folder"' EXIT
trap 'exit 130' INT TERM
root_make bullseye "$root" gcc g++ make cmake ninja-build git ca-certificates pkg-config libopenimageio-dev libopencolorio-dev libopenexr-dev \
    libembree-dev libegl-dev libopengl-dev libegl-mesa0 libgl1-mesa-dri libepoxy-dev libdeflate-dev libjson-c-dev libxxhash-dev patchelf xz-utils binutils
mkdir "$root/source" "$root/openexr" "$root/imath"
git ls-files | tar c -T - | tar x -C "$root/source"
cp -r "$openexr/." "$root/openexr"
cp -r "$imath/." "$root/imath"

cat >"$root/build.sh" <<'B'
set -eu
prefix=/opt/openexr older='-include /source/tests/dist/older_glibc.h'
make_it() { # FOLDER TARGET
    cmake -S "/$1" -B "/build-$1" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=$prefix -DCMAKE_INSTALL_LIBDIR=lib \
        -DCMAKE_PREFIX_PATH=$prefix -DBUILD_TESTING=OFF -DBUILD_WEBSITE=OFF -DOPENEXR_FORCE_INTERNAL_DEFLATE=ON \
        -DCMAKE_C_FLAGS="$older" -DCMAKE_CXX_FLAGS="$older"
    ninja -C "/build-$1" "$2"
}
make_it imath install
# Of OpenEXR the core library alone, which is what this program links.
make_it openexr OpenEXRCore
for part in src/lib/OpenEXRCore cmake; do cmake -P /build-openexr/$part/cmake_install.cmake; done
sed -i 's/^Libs:.*/Libs: -L${libdir} -lOpenEXRCore/; /^Requires.private:/d' $prefix/lib/pkgconfig/OpenEXR.pc
# This Debian's libdeflate came without one.
printf 'Name: libdeflate\nDescription: deflate\nVersion: 1.7\nLibs: -ldeflate\n' >$prefix/lib/pkgconfig/libdeflate.pc
cd /source
mkdir /licences
cp /openexr/LICENSE.md /licences/OpenEXR
[ ! -e /openexr/external/OpenJPH/LICENSE ] || cp /openexr/external/OpenJPH/LICENSE /licences/OpenJPH
XZ_LEVEL=$2 LICENCES=/licences PKG_CONFIG_PATH=$prefix/lib/pkgconfig make dist BUILD=build VERSION="$1" EXTRA_CFLAGS="$older" \
    PLUGIN='build/ssdo-images.so build/ssdo-trace.so'
mkdir /unpacked
tar x -C /unpacked -f build/*.tar.xz
sh tests/dist/symbols.sh /unpacked 2.31 >/symbols || { cat /symbols; exit 1; }
# What every run loads reaches glibc 2.28. The modules do not: their libraries are this Debian's packages, built by its compiler.
mkdir -p /every/bin
cp /unpacked/*/bin/ssdo-filter $(ldd /unpacked/*/bin/ssdo-filter | sed -n 's|.*=> \(/unpacked/[^ ]*\) .*|\1|p') /every/bin
[ "$(sh tests/dist/symbols.sh /every 2.28 | grep -c .)" = 0 ] || { sh tests/dist/symbols.sh /every; exit 1; }
B
root_run "$root" 0:0 "sh /build.sh $version ${XZ_LEVEL:-6}" >"$out/log" 2>&1 || { tail -n 20 "$out/log" >&2; exit 1; }
rm -f "$out"/*.tar.xz
cp "$root"/source/build/*.tar.xz "$root/symbols" "$out"
tail -n 5 "$out/log"
echo "symbols newer than glibc 2.28 and libstdc++ 3.4.25: $(wc -l <"$out/symbols"), in build/oldest/symbols"
root_leave "$root"
sh tests/dist/check.sh "$(echo "$out"/*.tar.xz)" bullseye bookworm trixie
