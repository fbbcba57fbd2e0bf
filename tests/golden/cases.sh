#!/bin/sh
# Files as strangers make them: parts and views under any name, one pass in a file, a deep part beside the flat one, lossy and unknown
# compression, odd file names. Each is read right, or refused with the reason; what is right is what the plain file gives.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
bad=0
say() { echo "FAILED: $*"; bad=1; }
V=ViewLayer
sample=$PWD/samples/still.exr
cd "$dir" || exit 1

# make FILE PARTNAME VIEW CHANNELS: one part cut from the sample.
make() {
    view=
    [ "$3" ] && view="--attrib view $3"
    # shellcheck disable=SC2086
    oiiotool "$sample" --cut 120x80+100+60 --ch "$4" --eraseattrib '.*' --attrib oiio:subimagename "$2" $view -o "$1" >/dev/null 2>&1 ||
        say "oiiotool $1"
}
rgba="R=$V.Combined.R,G=$V.Combined.G,B=$V.Combined.B,A=$V.Combined.A"
z="Z=$V.Depth.Z"
p="$V.Position.X,$V.Position.Y,$V.Position.Z"
n="$V.Normal.X,$V.Normal.Y,$V.Normal.Z"
join() { # FILE PART...
    to=$1
    shift
    exrmultipart -combine -i "$@" -o "$to" -override 1 >/dev/null 2>&1 || say "exrmultipart $to"
}
run() { # ARGS...: exit code in $code, all that was said in ./said
    "$SSDO" "$@" >said 2>&1
    code=$?
}
ok() { [ $code = 0 ] || { say "exit $code: $*"; cat said; }; }
said() { grep -qF -- "$1" said || { say "not said: '$1' ($2)"; cat said; }; }
role() { # FILE LINE ARGS...: --explain takes the role as told
    file=$1 line=$2
    shift 2
    run "$file" --explain --fov 40 "$@"
    said "$line" "$file $*"
}
same() { oiiotool --fail 0 --hardfail 0 --diff "$1" "$2" >diff 2>&1 || { say "$1 is not $2: $3"; cat diff; }; }
few="--samples 8 --layers occlusion --fov 40"

# --- parts are layers
make plain.exr "" "" "$rgba,$z"
# shellcheck disable=SC2086
run plain.exr $few -o plain_out.exr --keep none
ok plain
for name in rgba beauty persp; do
    make a.exr $name "" "$rgba,$z"
    make b.exr N "" "X=$V.Normal.X,Y=$V.Normal.Y,Z=$V.Normal.Z"
    join parts.exr a.exr b.exr
    role parts.exr "depth: $name.Z (part 0, float)"
    said "beauty: $name.R/G/B (part 0" $name
    said "normal: N.X/Y/Z" $name
done
make a.exr picture "" "$rgba"
make b.exr customDepth "" "$z"
join custom.exr a.exr b.exr
role custom.exr "depth: customDepth.Z"
said "beauty: picture.R/G/B" custom
run custom.exr --fov 40 --samples 8 -o composite.exr
ok custom
oiiotool --info -v composite.exr | grep -q composite.R || say "no composite of a named part's picture"

# --- views: LAYER_VIEW with any joint, the other eye's depth never
for joint in _ .; do
    make rl.exr "rgba${joint}left" left "$rgba"
    make rr.exr "rgba${joint}right" right "$rgba"
    make dl.exr "depth${joint}left" left "$z"
    oiiotool dl.exr --mulc 1.25 --eraseattrib '.*' --attrib oiio:subimagename "depth${joint}right" --attrib view right -o dr.exr >/dev/null 2>&1
    join stereo.exr rr.exr dl.exr rl.exr dr.exr
    role stereo.exr "depth: depth${joint}left.Z (part 1" --view-layer left
    role stereo.exr "depth: depth${joint}right.Z (part 3" --view-layer right
    role stereo.exr "depth: depth${joint}right.Z (part 3" --view-layer right --depth Z
    role stereo.exr "depth: depth${joint}right.Z (part 3" --view-layer right --depth "depth${joint}right.Z"
    said "beauty: rgba${joint}right.R/G/B (part 0" "$joint"
    run stereo.exr --fov 40 --depth "depth${joint}right.Z" -o no.exr
    [ $code = 3 ] && [ ! -e no.exr ] || say "the left eye took the right one's depth"
    said "--view-layer right" "$joint"
    for layout in single multipart; do
        # shellcheck disable=SC2086
        run stereo.exr $few --depth Z --layout $layout -o two.exr
        ok "$layout"
    done
    oiiotool two.exr --subimage ssdo.left --ch occlusion.R -o left.exr >/dev/null 2>&1 || say "no part ssdo.left"
    oiiotool two.exr --subimage ssdo.right --ch occlusion.R -o right.exr >/dev/null 2>&1 || say "no part ssdo.right"
    oiiotool --diff left.exr right.exr >/dev/null 2>&1 && say "both eyes have the same occlusion"
done
make rm.exr rgba_main main "$rgba"
make dm.exr depth_main main "depth.Z=$V.Depth.Z"
join main.exr rm.exr dm.exr
role main.exr "depth: depth_main.depth.Z"
said "beauty: rgba_main.R/G/B" main

# --- one pass a file
make depth.exr "" "" "Y=$V.Depth.Z"
# shellcheck disable=SC2086
run depth.exr $few -o depth_out.exr --keep none
ok depth.exr
same depth_out.exr plain_out.exr "one channel Y, and a file called depth"
make color.exr "" "" "$rgba"
make albedo.exr "" "" "R=$V.DiffCol.R,G=$V.DiffCol.G,B=$V.DiffCol.B"
run color.exr depth.exr albedo.exr --fov 40 --explain
said "beauty: R/G/B" color
said "albedo: albedo.R/G/B" color
said "depth: depth.Y" color

# --- a channel serves one role
make XYZ.exr "" "" "X=$V.Position.X,Y=$V.Position.Y,Z=$V.Position.Z"
make named.exr "" "" "P.X=$V.Position.X,P.Y=$V.Position.Y,P.Z=$V.Position.Z"
mv XYZ.exr xyz1.exr
run xyz1.exr --position X,Y,Z --samples 8 --layers occlusion -o xyz_out.exr --keep none
ok xyz
run named.exr --samples 8 --layers occlusion -o named_out.exr --keep none
ok named
same xyz_out.exr named_out.exr "X, Y and Z as positions"
run xyz1.exr --explain
[ $code = 3 ] || say "X, Y and Z alone are nothing"
said "CIE XYZ" xyz

# --- lists
make list.exr "" "" "$rgba,$z,N.X=$V.Normal.X,N.Y=$V.Normal.Y,N.Z=$V.Normal.Z"
run list.exr --depth Depth --fov 40 -o no.exr
said "which has R G B A, Z, N (" list
make rgb.exr "" "" "R=$V.Combined.R,G=$V.Combined.G,B=$V.Combined.B"
run rgb.exr --fov 40 -o no.exr
said "the file has R G B;" rgb

# --- a deep part beside the flat one
make flat.exr rgba "" "$rgba,$z"
oiiotool flat.exr --ch A,Z --deepen --eraseattrib '.*' --attrib oiio:subimagename deep -o deep.exr >/dev/null 2>&1 || say "oiiotool --deepen"
for order in "deep.exr flat.exr" "flat.exr deep.exr"; do
    # shellcheck disable=SC2086
    join mixed.exr $order
    for more in "" "--layout multipart" "--keep none"; do
        rm -f mixed_out.exr cut.*.exr
        # shellcheck disable=SC2086
        run mixed.exr $few $more -o mixed_out.exr
        ok "deep beside flat $more"
        [ "$more" = "--keep none" ] && { same mixed_out.exr plain_out.exr "$more"; continue; }
        exrmultipart -separate -i mixed_out.exr -o cut >/dev/null 2>&1
        for f in cut.*.exr; do exrheader "$f" | grep -q deepscanline && oiiotool --dumpdata "$f" | tail -n +2 >deep_out.txt; done
        oiiotool --dumpdata deep.exr | tail -n +2 >deep_in.txt
        cmp -s deep_in.txt deep_out.txt || say "the deep part is another ($order $more)"
    done
done
head -c "$(($(stat -c %s mixed.exr) - 500))" mixed.exr >cut.exr # the deep part's end is missing
# shellcheck disable=SC2086
run cut.exr $few -o no.exr
[ $code = 3 ] && [ ! -e no.exr ] || say "a damaged file with a deep part: exit $code"
run deep.exr --fov 40 -o no.exr
[ $code = 3 ] || say "a deep file was taken"
said "only deep data" deep

# --- compression
oiiotool "$sample" --cut 120x80+100+60 --ch "$p,$n" -d half --compression b44 -o b44.exr >/dev/null 2>&1 || say "oiiotool b44"
run b44.exr --explain
said "B44 compression stored the half floats of the position pass with loss" b44
said "B44 compression stored the half floats of the normal pass with loss" b44
place=$(grep -abo 'compression.compression.' plain.exr | head -1 | cut -d: -f1)
unknown='12 99'
case $(pkg-config --modversion OpenEXR) in 3.[123].*) unknown="10 11 $unknown" ;; esac # HTJ2K came with 3.4
for number in $unknown; do
    cp plain.exr new.exr
    printf "\\$(printf %o $number)" | dd of=new.exr bs=1 seek=$((place + 28)) conv=notrunc 2>/dev/null
    run new.exr --fov 40 -o no.exr
    [ $code = 3 ] && [ ! -e no.exr ] || say "compression $number: exit $code"
    said "method number $number" compression
    said "ZIP or PIZ" compression
done

# --- names of files
cp plain.exr a.0001.exr
cp plain.exr a.0002.exr
run a.0001.exr a.0002.exr --fov 40 -o "o.####.exr"
[ $code = 2 ] && [ ! -e "o.####.exr" ] || say "frames as arguments: exit $code"
said "a.####.exr" frames
i=100
many=
while [ $i -lt 140 ]; do many="$many v.$i.exr" i=$((i + 1)); done
# shellcheck disable=SC2086
run $many -o "o.####.exr"
[ $code = 2 ] || say "forty frames as arguments: exit $code"
said "v.###.exr" frames
for name in "shot #1.exr" "100%d.exr" "a\$F.exr"; do
    cp plain.exr "$name"
    # shellcheck disable=SC2086
    run "$name" $few -o literal.exr --keep none
    ok "$name"
    same literal.exr plain_out.exr "$name"
    run "$name" --fov 40 --explain
    ok "$name"
done
cp plain.exr "a.####.exr" # beside a sequence: the sequence, and a word
# shellcheck disable=SC2086
run "a.####.exr" $few -o "s.####.exr"
ok "a sequence beside a file of its pattern's name"
said "exactly this name" pattern
[ -e s.0001.exr ] && [ -e s.0002.exr ] || say "the sequence was not filtered"

# --- names of the output
for name in out.png out.TIFF; do
    run plain.exr --fov 40 -o $name
    [ $code = 2 ] && [ ! -e $name ] || say "$name was written"
done
# shellcheck disable=SC2086
run plain.exr $few -o out.tmp --keep none
ok out.tmp
said "does not end in .exr" ending
for option in -o --preview --report; do
    run plain.exr --fov 40 -o out.exr $option -
    [ $code = 2 ] && [ ! -e ./- ] && [ ! -e out.exr ] || say "$option - was taken"
done
run - --fov 40 -o out.exr
[ $code = 2 ] || say "- was taken as an input"
mkdir folder
ln -s real.exr folder/link.exr
ln -s folder/link.exr link.exr
ln -s nowhere/real.exr lost.exr
# shellcheck disable=SC2086
run plain.exr $few -o link.exr --keep none
ok link
[ -L link.exr ] && [ -L folder/link.exr ] && [ ! -L folder/real.exr ] || say "a link was replaced"
same folder/real.exr plain_out.exr link
run plain.exr --fov 40 -o lost.exr
[ $code = 4 ] && [ -L lost.exr ] || say "a link into no folder: exit $code"
exit $bad
