#!/bin/sh
# A program whose shaders or whose code for pixels changed makes the frames of --skip-existing again; one whose comments, README or other
# code changed does not. In two halves: which changes of a copy of the sources change the digest that goes into the program, and that a
# program with another digest makes frames again. The second is a copy of the program in which the digest's text is another.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; [ -s "$dir/log" ] && cat "$dir/log"; exit 1; }

mkdir "$dir/tree" && tar c Makefile VERSION README.md shaders src tests/version.sh | tar x -C "$dir/tree" || die copying
digest() {
    make -s -C "$dir/tree" BUILD=b b/decides.c >"$dir/log" 2>&1 || die "make: $1"
    sed -n 's/.*"\([0-9a-f]\{64\}\)".*/\1/p' "$dir/tree/b/decides.c"
}
plain=$(digest 'as it is')
[ -n "$plain" ] || die 'no digest'
# what WANTED FILE SED: the digest after the change, `same` or `other`; the file is put back.
what() {
    file=$dir/tree/$2
    cp -p "$file" "$dir/kept"
    sed -i "$3" "$file"
    cmp -s "$file" "$dir/kept" && die "$2: '$3' changes nothing"
    touch -d '+1 hour' "$file" # later than what was made of it, whatever the clock's steps
    rm -f "$dir/tree/b/decides.c"
    if [ "$(digest "$2")" = "$plain" ]; then got=same; else got=other; fi
    [ $got = "$1" ] || die "$2: after '$3' the digest is $got"
    mv "$dir/kept" "$file"
    changes=$((changes + 1))
}
changes=0
what same README.md '1s/$/ changed/'
what same shaders/arc_light.comp '1i// another comment'
what same shaders/arc_light.comp 's/^    /        /'
what same src/passes/arc.c '1i/* another comment, on\n two lines */'
what same src/cli/progress.c '$aint not_of_pixels;'
what same src/pipeline/report.c '$aint not_of_pixels;'
what same src/main.c '$aint not_of_pixels;'
what other shaders/arc_light.comp '$aconst float added = 1.0;'
what other shaders/include/params.glsl '$aconst float added = 1.0;'
what other src/passes/arc.c '$aint added;'
what other src/gbuffer/radius.c '$aint added;'
what other src/plugin/images_shim.cpp '$aint added;'
what other src/passes/arc.c '0,/"[a-z]/s//"x&/'

# The program itself, with the digest of another source.
[ "$(grep -c "$plain" "$SSDO")" = 1 ] || die 'the program does not hold the digest of this source'
folder=${SSDO%/*}
sed "s/$plain/$(echo "$plain" | tr 0-9a-f 1-9a-f0)/" "$SSDO" >"$dir/changed"
chmod +x "$dir/changed"
export SSDO_PLUGIN_DIR="$folder"
oiiotool samples/still.exr --cut 40x32+200+120 --origin +0+0 --fullpixels -o "$dir/in.exr" || die oiiotool
run() { "$1" "$dir/in.exr" -o "$dir/out.exr" --samples 4 --skip-existing >"$dir/log" 2>&1 || die "$1"; }
said() { grep -q 'skipped, already done' "$dir/log"; }
run "$SSDO"; said && die 'the first run: taken for done'
run "$SSDO"; said || die 'the same program: made again'
run "$dir/changed"; said && die 'other code for pixels: taken for done'
run "$dir/changed"; said || die 'other code for pixels: made twice'
run "$SSDO"; said && die 'back: taken for done'
echo "figure: --skip-existing: $changes changes of sources told apart, a program with another digest makes its frames again"
