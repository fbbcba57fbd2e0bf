#!/bin/sh
# sequences.sh BUILD SAMPLES SEEDS [WORD]: the table of sequences.c. The shaders it runs are a copy of shaders/ (SSDO_SHADER_DIR) whose
# pixel_noise and step_distance have the alternatives of sequences.glsl and spacings.glsl beside them. WORD tries only rows that hold it.
set -e
build=$1
dir=$build/sequences
here=$(dirname "$0")
rm -rf "$dir" && mkdir -p "$dir" && cp -r shaders/. "$dir"
put() { # FILE NAME ALTERNATIVES: renames the shader's own function to chosen_NAME
    grep -q " $2(" "$dir/include/$1" || { echo "$1 has no $2 any more" >&2; exit 1; }
    { sed "s/ $2(/ chosen_$2(/" "shaders/include/$1"; cat "$here/$3"; } >"$dir/include/$1"
}
put sampling.glsl pixel_noise sequences.glsl
put arc_line.glsl step_distance spacings.glsl
SSDO_SHADER_DIR=$dir "$build/bench-sequences" "$2" "$3" ${4:+"$4"}
