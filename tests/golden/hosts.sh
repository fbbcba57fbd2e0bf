#!/bin/sh
# Programs a compositor uses read what we write: oiiotool, OpenEXR's own tools, Blender's image loader.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
"$SSDO" -q samples/still.exr -o "$dir/out.exr" || exit 1
for tool in oiiotool exrheader blender; do
    command -v $tool >/dev/null 2>&1 || { echo "no $tool here"; exit 77; }
done
oiiotool --info -v "$dir/out.exr" | grep -q 'composite.R' || { echo "oiiotool does not see our layers"; exit 1; }
oiiotool --stats "$dir/out.exr" | grep -q 'NanCount' || exit 1
exrheader "$dir/out.exr" | grep -q 'ssdo/version' || { echo "exrheader does not see our attributes"; exit 1; }
# The input's channels, by oiiotool's own comparison.
names=$(oiiotool --info -v samples/still.exr | sed -n 's/ *channel list: //p' | sed 's/ ([a-z]*)//g; s/ //g')
oiiotool samples/still.exr --ch "$names" -o "$dir/a.exr" && oiiotool "$dir/out.exr" --ch "$names" -o "$dir/b.exr" || exit 1
oiiotool --diff "$dir/a.exr" "$dir/b.exr" | grep -q PASS || { echo "oiiotool finds changed channels"; exit 1; }
# --main composite: the nameless channels are the composite, and nothing else of the input is gone.
"$SSDO" -q samples/still.exr -o "$dir/main.exr" --main composite || exit 1
oiiotool "$dir/main.exr" --ch R,G,B,A -o "$dir/a.exr" && oiiotool "$dir/main.exr" --ch composite.R,composite.G,composite.B,composite.A -o "$dir/b.exr" || exit 1
oiiotool --diff --fail 0 --warn 0 "$dir/a.exr" "$dir/b.exr" >/dev/null || { echo "R, G, B and A are not the composite"; exit 1; }
"$SSDO" -q "$dir/main.exr" -o "$dir/x.exr" --main composite --layers occlusion 2>&1 | grep -q 'needs the composite layer' || { echo "no error without a composite"; exit 1; }
cat >"$dir/look.py" <<'P'
import bpy, sys
image = bpy.data.images.load(sys.argv[-1])
tree = bpy.context.scene
tree.use_nodes = True
node = tree.node_tree.nodes.new("CompositorNodeImage")
node.image = image
print("SOCKETS", image.type, ",".join(s.name for s in node.outputs))
P
see() { blender -b --factory-startup -P "$dir/look.py" -- "$1" 2>&1 | sed -n 's/^SOCKETS //p'; }
case $(see "$dir/out.exr") in
*MULTILAYER*Position*) ;;
*) echo "Blender does not load the file"; exit 1 ;;
esac
# Blender shows the passes of a named layer; under the view layer's name ours stand beside its own.
"$SSDO" -q samples/still.exr -o "$dir/prefix.exr" --prefix ViewLayer. || exit 1
sockets=$(see "$dir/prefix.exr")
for layer in occlusion radiance indirect composite; do
    case $sockets in
    *$layer*) ;;
    *) echo "Blender shows no socket '$layer': $sockets"; exit 1 ;;
    esac
done
echo "figure: Blender's sockets: $sockets"
