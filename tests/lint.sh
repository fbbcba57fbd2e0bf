#!/bin/sh
# lint.sh BUILD: formatting and shader validation. Compiler warnings are errors in `make lint`'s second step.
set -eu
out=$1/lint
mkdir -p "$out"
clang-format --dry-run -Werror $(find src tests -name '*.[ch]' -o -name '*.cpp' -path 'src/*')

# Every variant that a pass can ask for, in both ways of reading pictures. A hundred files a run: starting the validator is what costs.
count=0
for read in image texture; do
    rm -rf "$out/$read" && mkdir -p "$out/$read"
    "$1/tests/list_variants" files "$out/$read" "$read" 2>"$out/count"
    find "$out/$read" -name '*.comp' -o -name '*.frag' | xargs -n 100 glslangValidator >"$out/log" ||
        { echo "lint: $read:" >&2; grep -B 1 -A 3 ERROR "$out/log" >&2; exit 1; }
    count=$((count + $(cat "$out/count")))
done
echo "lint: formatting clean, $count shader programs valid"
