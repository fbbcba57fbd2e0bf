#!/bin/sh
# lint.sh BUILD: formatting and shader validation. Compiler warnings are errors in `make lint`'s second step.
set -eu
out=$1/lint
mkdir -p "$out"
clang-format --dry-run -Werror $(find src tests -name '*.[ch]' -o -name '*.cpp' -path 'src/*')

# glslangValidator knows #include only as an extension that drivers lack, so the files are spliced the way src/gpu/program.c does.
splice() {
    awk -v dir=shaders '
        function cat(file,  line, name) {
            while ((getline line < file) > 0) {
                if (line !~ /^#include "/) { print line; continue }
                name = line
                sub(/^#include "/, "", name)
                sub(/".*/, "", name)
                if (!(name in seen)) { seen[name] = 1; cat(dir "/" name) }
            }
            close(file)
        }
        BEGIN { cat(ARGV[1]); exit }' "$1"
}

# A shader with compile-time variants lists the sets to check in a comment: // lint: A B=2 | C. Each is checked for both cameras.
count=0
for f in shaders/*.comp shaders/*.frag; do
    case $f in *.frag) kind=-DFRAGMENT=1 ;; *) kind= ;; esac
    splice "$f" >"$out/$(basename "$f")"
    sets=$(sed -n 's|^// lint: *||p' "$f")
    echo "${sets:-NOTHING}" | tr '|' '\n' >"$out/sets"
    while read -r set; do
        defines=
        for d in $set; do case $d in *=*) defines="$defines -D$d" ;; *) defines="$defines -D$d=1" ;; esac; done
        for camera in "" -DORTHOGRAPHIC=1; do
            glslangValidator -l $kind $defines $camera "$out/$(basename "$f")" >"$out/log" ||
                { echo "lint: $f with $set $camera:" >&2; cat "$out/log" >&2; exit 1; }
            count=$((count + 1))
        done
    done <"$out/sets"
done
echo "lint: formatting clean, $count shader variants valid"
