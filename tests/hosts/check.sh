#!/bin/sh
# check.sh BUILD: what we write, in the programs it is for. Blender's compositor, headless, shows the layers and rebuilds the
# composite from them; oiiotool, exrmultipart and ImageMagick read a file and write it again, and nothing is lost.
set -u
SSDO=$(cd "$1" && pwd)/ssdo-filter
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
trap 'exit 130' INT TERM
die() { echo "FAILED: $*" >&2; exit 1; }
V=ViewLayer
ours="occlusion.R,radiance.R,radiance.G,radiance.B,indirect.R,indirect.G,indirect.B,composite.R,composite.G,composite.B,composite.A"

# channels FILE: its channel names, of all sub-images, sorted, one a line.
channels() { oiiotool --info -v -a "$1" | sed -n 's/ *channel list: //p' | sed 's/ ([a-z]*)//g' | tr ',' '\n' | sed 's/ //g' | sort; }
# same_channels LIST A B: those channels hold the same values in both files, whatever their order.
same_channels() {
    oiiotool "$2" --ch "$1" -o "$dir/x.exr" && oiiotool "$3" --ch "$1" -o "$dir/y.exr" || die "$3 lacks channels"
    oiiotool --diff --fail 0 --warn 0 "$dir/x.exr" "$dir/y.exr" >"$dir/log" || die "$3: $(cat "$dir/log")"
}

# ---- Blender: under the view layer's name the layers are sockets of the Image node, and nodes make the composite of them.
"$SSDO" -q samples/still.exr -o "$dir/blender.exr" --env samples/sky_soft.exr --prefix $V. || die "ssdo-filter"
blender -b --factory-startup -P tests/hosts/rebuild.py -- "$dir/blender.exr" "$dir/" >"$dir/log" 2>&1 || die "Blender: $(cat "$dir/log")"
sockets=$(sed -n 's/^SOCKETS MULTILAYER //p' "$dir/log")
for layer in occlusion radiance indirect composite; do
    case ,$sockets, in *,$layer,*) ;; *) die "Blender shows no socket '$layer': $sockets" ;; esac
done
for f in rebuilt composite; do oiiotool "$dir/${f}0001.exr" --ch R,G,B -o "$dir/$f.exr" || die "Blender wrote no $f: $(cat "$dir/log")"; done
oiiotool "$dir/blender.exr" --ch R=$V.composite.R,G=$V.composite.G,B=$V.composite.B -d float -o "$dir/written.exr"
oiiotool --diff --fail 0 "$dir/written.exr" "$dir/composite.exr" >"$dir/log" || die "Blender changes the composite: $(cat "$dir/log")"
# Three halves, each rounded to 11 bits, and values below 1.
oiiotool --diff --fail 0.001 "$dir/rebuilt.exr" "$dir/composite.exr" >"$dir/log" || die "DiffCol * (radiance + indirect) is not the composite: $(cat "$dir/log")"
echo "ok      Blender: sockets $sockets"
echo "ok      Blender: DiffCol * (radiance + indirect) is the composite,$(sed -n 's/ *Max error/ greatest difference/p' "$dir/log" | sed 's/ @.*//')"

# ---- Blender's own stereo file, one part: each eye filtered with its own camera, and read again as stereo.
stereo() { blender -b --factory-startup -P tests/hosts/stereo.py -- "$1" "$2" >"$dir/log" 2>&1; }
stereo render "$dir/eyes.exr" && [ -s "$dir/eyes.exr" ] || die "Blender renders no stereo: $(tail "$dir/log")"
"$SSDO" -q "$dir/eyes.exr" -o "$dir/both.exr" --prefix $V. --env samples/sky_soft.exr || die "ssdo-filter with two eyes"
stereo show "$dir/both.exr" && sockets=$(sed -n 's/^SOCKETS stereo //p' "$dir/log")
for layer in occlusion radiance indirect composite; do
    case ,$sockets, in *,$layer,*) ;; *) die "Blender shows no stereo socket '$layer': $(grep SOCKETS "$dir/log")" ;; esac
done
exrheader "$dir/both.exr" >"$dir/log"
[ "$(grep -c "$V.occlusion.\(left\|right\).R" "$dir/log")" = 2 ] || die "not an occlusion for each eye: $(cat "$dir/log")"
[ "$(sed -n 's/^ssdo.camera.*centre \([0-9.]*\) .*source fit"$/\1/p' "$dir/log" | sort -u | wc -l)" = 2 ] || die "the eyes' cameras: $(grep ssdo.camera "$dir/log")"
echo "ok      Blender: its stereo file is filtered eye by eye and comes back as stereo"

# ---- oiiotool: all channels and our attributes survive, and a run on the copy gives our layers again.
"$SSDO" -q samples/still.exr -o "$dir/out.exr" --env samples/sky_soft.exr --main composite || die "ssdo-filter"
oiiotool "$dir/out.exr" -o "$dir/oiio.exr" || die "oiiotool"
all=$(channels "$dir/out.exr" | tr '\n' ',' | sed 's/,$//')
same_channels "$all" "$dir/out.exr" "$dir/oiio.exr"
for name in version args device camera radius method environment premult; do
    want=$(exrheader "$dir/out.exr" | grep "^ssdo/$name ") || die "no attribute ssdo/$name"
    [ "$(exrheader "$dir/oiio.exr" | grep "^ssdo/$name ")" = "$want" ] || die "oiiotool loses ssdo/$name"
done
"$SSDO" -q "$dir/oiio.exr" -o "$dir/again.exr" --env samples/sky_soft.exr --main composite || die "a second run"
same_channels "$ours" "$dir/out.exr" "$dir/again.exr"
echo "ok      oiiotool: $(channels "$dir/out.exr" | wc -l) channels and the attributes come back; a second run gives the same layers"

# ---- exrmultipart: our second part, taken apart and put together again.
"$SSDO" -q samples/still.exr -o "$dir/parts.exr" --env samples/sky_soft.exr --layout multipart || die "ssdo-filter"
(cd "$dir" && exrmultipart -separate -i parts.exr -o part && exrmultipart -combine -i part.1.exr::input part.2.exr::ssdo -o combined.exr) \
    >"$dir/log" 2>&1 || die "exrmultipart: $(cat "$dir/log")"
[ "$(channels "$dir/combined.exr")" = "$(channels "$dir/parts.exr")" ] || die "exrmultipart changes the channels"
same_channels "$ours" "$dir/part.2.exr" "$dir/out.exr"
"$SSDO" -q "$dir/combined.exr" -o "$dir/again.exr" --env samples/sky_soft.exr --layers occlusion --keep none || die "a run on the parts"
same_channels occlusion.R "$dir/again.exr" "$dir/out.exr"
echo "ok      exrmultipart: two parts separated, combined, and filtered again to the same occlusion"

# ---- ImageMagick knows only R, G, B and A: with --main composite they are the composite.
convert "$dir/out.exr" "$dir/magick.exr" 2>"$dir/log" || die "ImageMagick: $(cat "$dir/log")"
oiiotool "$dir/out.exr" --ch R=composite.R,G=composite.G,B=composite.B,A=composite.A -d half -o "$dir/main.exr"
oiiotool --diff --fail 0.001 "$dir/main.exr" "$dir/magick.exr" >"$dir/log" || die "ImageMagick shows another picture: $(cat "$dir/log")"
convert "$dir/out.exr" "$dir/magick.png" && [ "$(identify -format '%wx%h' "$dir/magick.png")" = 480x270 ] || die "ImageMagick writes no PNG"
echo "ok      ImageMagick: reads the composite and writes it again,$(sed -n 's/ *Max error/ greatest difference/p' "$dir/log" | sed 's/ @.*//')"
