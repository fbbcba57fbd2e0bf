#!/bin/sh
# lint.sh [BUILD]: what the compilers warn of, formatting, the tree's own rules and every shader program. BUILD, by default the folder
# of $SSDO, holds a whole build.
set -eu
build=${1:-$(dirname "$SSDO")}
out=$build/lint
mkdir -p "$out"
# The format is that of clang-format 14; newer ones agree on most of it, and where they do not, the code is not at fault.
sources=$(find src tests -name '*.[ch]' -o -name '*.cpp' -path 'src/*')
formatter=$(clang-format --version | sed 's/.*version \([0-9]*\).*/\1/')
format='formatting clean'
if [ "$formatter" = 14 ]; then
    clang-format --dry-run -Werror $sources
elif ! clang-format --dry-run -Werror $sources >"$out/format" 2>&1; then
    format="formatting not judged: it is checked by clang-format 14, and $formatter would change $(grep -c 'code should be' "$out/format") places"
fi

# What gcc said is in the build; clang reads the sources now.
make -s BUILD="$build" lint-warnings || { echo 'lint: the build has warnings' >&2; exit 1; }
make -s BUILD="$build" lint-clang

# The tree's own rules (src/README.md, "Habits"): lengths, nothing cited that a reader does not have, no files that include each other.
refuse() { [ -z "$2" ] || { printf 'lint: %s:\n%s\n' "$1" "$2" >&2; exit 1; }; }
refuse 'longer than 500 lines' "$(find src shaders tests -name '*.[ch]' -o -name '*.cpp' -o -name '*.comp' -o -name '*.glsl' -o -name '*.sh' -o \
    -name '*.py' | xargs wc -l | awk '$2 != "total" && $1 > 500')"
refuse 'longer than 200 lines' "$(awk 'END { if (NR > 200) print FILENAME ": " NR }' README.md)"
refuse 'names what is not in the tree' "$(grep -rnIiE 'the seed[s]|the lectur[e]|chapter [0-9]|THEORY\.md|DESIGN\.md|[^a-z]fact[s]/' \
    src shaders tests --include='*.*' --exclude=lint.sh || true)"
refuse 'names a file that is not there' "$(grep -rnoIE '\b(src|shaders|tests|samples|man)/[A-Za-z0-9_/]+\.(md|c|h|cpp|comp|glsl|sh|py|json|1)\b' \
    README.md src shaders tests man | while IFS=: read -r file line name; do [ -e "$name" ] || echo "$file:$line: $name"; done)"
refuse 'include each other in a circle' "$(python3 tests/include_circles.py src)"

# A room of src includes those before it in this list alone (src/README.md).
later=
for room in library pipeline passes gpu light gbuffer exr cli plugin base; do
    [ -z "$later" ] || ! grep -nE "^#include \"($later)/" src/$room/*.[ch] || { echo "lint: $room may not include these" >&2; exit 1; }
    later=$room${later:+|$later}
done

# Every variant that a pass can ask for, in both ways of reading pictures. A hundred files a run: starting the validator is what costs.
count=0
for read in image texture; do
    rm -rf "$out/$read" && mkdir -p "$out/$read"
    "$build/tests/list_variants" files "$out/$read" "$read" 2>"$out/count"
    find "$out/$read" -name '*.comp' -o -name '*.frag' | xargs -n 100 glslangValidator >"$out/log" ||
        { echo "lint: $read:" >&2; grep -B 1 -A 3 ERROR "$out/log" >&2; exit 1; }
    count=$((count + $(cat "$out/count")))
done
echo "lint: $format, $count shader programs valid"
