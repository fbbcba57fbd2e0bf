# SPDX-License-Identifier: CC0-1.0
"""Loads an output into Blender's compositor, prints its sockets, and rebuilds the composite from the layers with nodes.

    blender -b --factory-startup -P tests/hosts/rebuild.py -- in.exr out_folder

Writes out_folder/rebuilt0001.exr = DiffCol * (radiance + indirect) and out_folder/composite0001.exr, both as 32-bit float.
"""
import sys

import bpy

path, folder = sys.argv[sys.argv.index("--") + 1:]
image = bpy.data.images.load(path)
scene = bpy.context.scene
scene.use_nodes = True
scene.render.resolution_x, scene.render.resolution_y = image.size
tree = scene.node_tree
tree.nodes.clear()
source = tree.nodes.new("CompositorNodeImage")
source.image = image
print("SOCKETS", image.type, ",".join(s.name for s in source.outputs))


def mix(kind, a, b):
    node = tree.nodes.new("CompositorNodeMixRGB")
    node.blend_type = kind
    tree.links.new(a, node.inputs[1])
    tree.links.new(b, node.inputs[2])
    return node.outputs[0]


light = mix("ADD", source.outputs["radiance"], source.outputs["indirect"])
files = tree.nodes.new("CompositorNodeOutputFile")
files.base_path = folder
files.format.file_format = "OPEN_EXR"
files.format.color_depth = "32"
files.file_slots.clear()
for name, socket in (("rebuilt", mix("MULTIPLY", source.outputs["DiffCol"], light)), ("composite", source.outputs["composite"])):
    files.file_slots.new(name)
    tree.links.new(socket, files.inputs[name])
bpy.ops.render.render()
