#!/bin/sh
# covered.sh BUILD DIR OUT [OPTION...]: runs the program with the OPTIONs on the scenes of DIR (samples/render.py), each with its own
# sky and radius, and scores what it writes to OUT against their truth. SCENES: only these. BIN: the program, instead of BUILD's.
# PICTURES: the pictures come from this folder, where the same scenes are lit by other skies, which are given as --beauty-env.
# AROUND: "around", "around ahead": with these lat-long G-buffers of render.py --around, which lie beside the scenes.
set -e
build=$1 dir=$2 out=$3
shift 3
mkdir -p "$out"
bin=${BIN:-$build/ssdo-filter}
"$build/tests/bench/score" "$dir" list | while read -r name file sky turn radius; do
    case " ${SCENES:-$name} " in *" $name "*) ;; *) continue ;; esac
    also=
    for view in $AROUND; do also="$also --also $dir/${name}_$view.exr"; done
    lit=
    if [ -n "$PICTURES" ]; then
        lit=$("$build/tests/bench/score" "$PICTURES" list | awk -v n="$name" '$1 == n { print "--beauty-env", $3, "--beauty-env-rotate", $4 }')
        file=$PICTURES/$name.exr
    fi
    # shellcheck disable=SC2086
    "$bin" -q "$file" -o "$out/$name.exr" --layers occlusion,radiance,indirect --keep none \
        --env "$sky" --env-rotate "$turn" --radius "$radius" $also $lit "$@"
done
"$build/tests/bench/score" "$dir" "$out" ${SCENES:-}
