#!/bin/sh
# lint.sh BUILD: formatting and shader validation. Compiler warnings are errors in `make lint`'s second step.
set -eu
build=$1
clang-format --dry-run -Werror $(find src tests -name '*.[ch]' -o -name '*.cpp' -path 'src/*')
out=$build/lint
mkdir -p "$out"
for f in shaders/*.comp shaders/*.frag shaders/*.vert; do
    [ -e "$f" ] || continue
    # glslangValidator knows includes only as an extension the drivers lack, so we splice them as the program does.
    awk -v dir=shaders 'function cat(file,  line, name) { while ((getline line < file) > 0) { if (line ~ /^#include "/) { name = line; sub(/^#include "/, "", name); sub(/".*/, "", name); if (!(name in seen)) { seen[name] = 1; cat(dir "/" name) } } else print line } close(file) } BEGIN { cat(ARGV[1]); exit }' "$f" >"$out/$(basename "$f")"
    glslangValidator "$out/$(basename "$f")" >"$out/log" || { cat "$out/log" >&2; exit 1; }
done
echo "lint: formatting and $(ls shaders/*.comp 2>/dev/null | wc -l) shaders are clean"
