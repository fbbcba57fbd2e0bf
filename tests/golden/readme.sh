#!/bin/sh
# The commands of README.md and of the pages it sends to, as typed, from a folder that looks like a clone: each succeeds and prints what the README says, and the
# files that it names are there. Fences marked ```sh KIND are others' (tests/readme.sh): farm commands are make check-farm's, slow ones
# nobody's.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; exit 1; }
command -v parallel >/dev/null || { echo "no GNU parallel here"; exit 77; }
sh tests/readme.sh "" >"$dir/commands"
ln -s "$PWD/samples" "$PWD/tests" "$dir"
mkdir "$dir/bin" && ln -s "$SSDO" "$dir/bin/ssdo-filter"
PATH=$dir/bin:$PATH
unset OCIO
plain() { sed 's/[0-9.]* s$/N s/' "$@"; } # without times
cd "$dir" || exit 1
count=0
while IFS= read -r line <&3; do
    case $line in
    '#=> ...') ;;
    '#=> '*) plain log | grep -qxF -- "$(echo "${line#??? }" | plain)" || die "'$command' does not print '${line#??? }' but: $(cat log)" ;;
    *)
        command=$line count=$((count + 1))
        sh -c "$command" >log 2>&1 || die "'$command' ended with $?: $(tail -5 log)"
        case $command in *--explain) grep -q '^convention  blender, recognised by' log || die "--explain prints: $(cat log)" ;; esac
        ;;
    esac
done 3<commands
[ $count -ge 12 ] || die "only $count commands were found in README.md"
for f in out.exr layers.png merged.exr look.0004.png look.0008.png look.0012.png shot.json stored.exr; do [ -s try/$f ] || die "no try/$f"; done
[ "$(ls try | grep -c '^look')" = 3 ] || die "previews: $(ls try)"
for i in 01 02 03 04 05 06 07 08 09 10 11 12; do cmp "try/lit.00$i.exr" "try/par.00$i.exr" || die "GNU parallel makes another frame $i"; done
