#!/bin/sh
# compilers.sh COMPILER...: the tree by each ("gcc-14", "clang-19", with their C++ side): program, library, modules and all tests, in a
# folder of its own below build/compilers. Fails where one does not build or has a warning to give.
set -u
failed=0
[ $# -gt 0 ] || { echo "which? make check-compilers COMPILERS='gcc-14 clang-19'" >&2; exit 2; }
# Distributions let their compilers watch the bounds of buffers, Ubuntu by the highest level, and each level has warnings of its own.
fortified() {
    for level in 3 2; do
        flag="-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=$level"
        # shellcheck disable=SC2086
        echo '#include <stdio.h>' | "$1" $flag -O2 -Werror -x c -c -o /dev/null - 2>/dev/null && { echo "$flag"; return; }
    done
}
for cc in "$@"; do
    cxx=$(echo "$cc" | sed 's/gcc/g++/; s/clang/clang++/')
    tree=build/compilers/$cc
    mkdir -p "$tree"
    if ! make --no-print-directory -j "$(nproc)" BUILD="$tree" CC="$cc" CXX="$cxx" EXTRA_CFLAGS="$(fortified "$cc")" all unit >"$tree/log" 2>&1; then
        failed=1
        echo "FAILED $cc: it does not build: $(grep -m 1 -E 'error|not found' "$tree/log")"
    elif said=$(find "$tree" -name '*.warnings' -size +0 -exec cat {} + | grep -m 1 'warning:'); then
        failed=1
        echo "FAILED $cc: $(find "$tree" -name '*.warnings' -exec cat {} + | grep -c 'warning:') warnings: $said"
    else
        echo "ok $cc: $(find "$tree" -name '*.warnings' | wc -l) files, no warning"
    fi
done
exit $failed
