#!/bin/sh
# A program without its modules: what needs one is refused before any work, and nothing is written. What a run tells with -v does
# not depend on whether it is a frame alone or a sequence of one.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; exit 1; }
mkdir "$dir/bin" && cp "$SSDO" "$dir/bin/ssdo-filter"
unset SSDO_PLUGIN_DIR OCIO
oiiotool samples/still.exr --cut 96x54+192+108 --origin +0+0 --fullpixels -o "$dir/in.0001.exr" || die oiiotool
in=$dir/in.0001.exr

"$dir/bin/ssdo-filter" -v "$in" -o "$dir/out.exr" --preview "$dir/p.png" --samples 4 2>"$dir/said"
code=$?
if [ $code = 0 ]; then
    echo "note: modules are installed where every program finds them; a missing one is not tried"
else
    [ $code = 4 ] || die "a preview without its module: exit $code"
    grep -q 'ssdo-images.so' "$dir/said" || die "it does not name the module: $(cat "$dir/said")"
    [ ! -e "$dir/out.exr" ] || die "the frame was filtered before the missing module was told"
    grep -q '^ssdo-filter: *position\|pass .* runs' "$dir/said" && die "work was done first: $(cat "$dir/said")"
fi

# DWA, in the input and in the environment, needs no OpenImageIO.
if [ -e "$(dirname "$SSDO")/ssdo-dwa.so" ]; then cp "$(dirname "$SSDO")/ssdo-dwa.so" "$dir/bin"; fi
oiiotool "$in" --compression dwaa -o "$dir/dwa.exr" && oiiotool samples/sky_sun.exr --compression dwab -o "$dir/sky.exr" || die "oiiotool --compression"
"$dir/bin/ssdo-filter" -v "$dir/dwa.exr" -o "$dir/out.exr" --env "$dir/sky.exr" --samples 4 --radius 1 2>"$dir/said" || die "DWA without OpenImageIO: $(cat "$dir/said")"

said() { sed 's/: [0-9.]* s$//; s/in [0-9.]* s//' "$dir/$1" | grep -v '^frame 1 (1 of 1)\|^ssdo-filter: 100 %\|whole sequence' | sort; }
"$SSDO" -v "$in" -o "$dir/alone.exr" --samples 4 --radius 1 --progress none 2>"$dir/alone" || die "alone"
"$SSDO" -v "$dir/in.####.exr" -o "$dir/many.####.exr" --samples 4 --radius 1 --progress none 2>"$dir/many" >/dev/null || die "sequence"
said alone >"$dir/a"
said many >"$dir/b"
cmp -s "$dir/a" "$dir/b" || die "-v differs: $(diff "$dir/a" "$dir/b")"
[ "$(wc -l <"$dir/a")" -gt 5 ] || die "-v says only $(cat "$dir/a")"
