# SPDX-License-Identifier: CC0-1.0
"""Loads outputs into Blender's compositor, prints their sockets, and rebuilds their composites from the layers with nodes.

    blender -b --factory-startup -P tests/hosts/rebuild.py -- in.exr out_folder [in.exr out_folder ...]

Writes out_folder/rebuilt0001.exr = DiffCol * (radiance + indirect) and out_folder/composite0001.exr, both as 32-bit float.
"""
import re
import sys

import bpy

scene = bpy.context.scene
scene.use_nodes = True
tree = scene.node_tree


def layers(node):
    """The names of an image's layers, which Blender tells only when one is not found."""
    try:
        node.layer = "?"
    except TypeError as e:
        return re.findall(r"'([^']+)'", str(e).split("not found in")[1])
    return []


# Blender 3.4 puts all parts of a file into one layer; 4.3 makes a layer of each.
def load(image, layer=None):
    node = tree.nodes.new("CompositorNodeImage")
    node.image = image
    if layer:
        node.layer = layer
    return node


def mix(kind, a, b):
    node = tree.nodes.new("CompositorNodeMixRGB")
    node.blend_type = kind
    tree.links.new(a, node.inputs[1])
    tree.links.new(b, node.inputs[2])
    return node.outputs[0]


def rebuild(path, folder):
    image = bpy.data.images.load(path)
    scene.render.resolution_x, scene.render.resolution_y = image.size
    tree.nodes.clear()
    sources = {}
    first = load(image)
    for node in [load(image, layer) for layer in layers(first)] if first.has_layers else [first]:
        for socket in node.outputs:
            sources.setdefault(socket.name, socket)
    print("SOCKETS", image.type, ",".join(sources))
    light = mix("ADD", sources["radiance"], sources["indirect"])
    files = tree.nodes.new("CompositorNodeOutputFile")
    files.base_path = folder
    files.format.file_format = "OPEN_EXR"
    files.format.color_depth = "32"
    files.file_slots.clear()
    for name, socket in (("rebuilt", mix("MULTIPLY", sources["DiffCol"], light)), ("composite", sources["composite"])):
        files.file_slots.new(name)
        tree.links.new(socket, files.inputs[name])
    bpy.ops.render.render()


words = sys.argv[sys.argv.index("--") + 1:]
for path, folder in zip(words[::2], words[1::2]):
    rebuild(path, folder)
