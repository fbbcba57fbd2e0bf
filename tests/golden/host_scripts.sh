#!/bin/sh
# samples/hosts: all are Python, the knobs of Nuke's take values that the program takes, and Blender's runs.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; exit 1; }
for script in samples/hosts/*.py; do
    PYTHONPYCACHEPREFIX="$dir" python3 -m py_compile "$script" || die "$script is not Python"
done
for method in $(sed -n 's/^METHODS = \[\(.*\)\]/\1/p' samples/hosts/nuke.py | tr -d '",'); do
    "$SSDO" samples/still.exr --explain -q --method "$method" --radius auto --quality draft >/dev/null 2>"$dir/said" ||
        die "nuke.py's method $method: $(cat "$dir/said")"
done
command -v blender >/dev/null 2>&1 || { echo "no blender here"; exit 77; }
blender -b --factory-startup -P samples/hosts/blender.py -- "$dir/out" >"$dir/said" 2>&1 || die "$(tail -5 "$dir/said")"
grep -q '^layers: .*composite' "$dir/said" || die "no layers in the compositor: $(tail -5 "$dir/said")"
for made in passes.exr lit.exr composite.png lit.blend; do
    [ -s "$dir/out/$made" ] || die "$made was not made"
done
# The program's failure is the script's.
SSDO=false blender -b --factory-startup -P samples/hosts/blender.py -- "$dir/bad" >"$dir/said" 2>&1 && die "a failed filter went unnoticed"
[ ! -e "$dir/bad/lit.blend" ] || die "a scene after a failed filter"
exit 0
