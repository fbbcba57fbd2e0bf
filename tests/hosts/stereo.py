# SPDX-License-Identifier: CC0-1.0
"""Renders Blender's default scene in stereo into one part with views in the channel names, or says how Blender reads such a file.

    blender -b --factory-startup -P tests/hosts/stereo.py -- render out.exr
    blender -b --factory-startup -P tests/hosts/stereo.py -- show in.exr
"""
import sys

import bpy


def render(path):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = 4, False
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 160, 90, 100
    scene.render.use_multiview, scene.render.views_format = True, "STEREO_3D"
    scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
    scene.render.image_settings.views_format = "MULTIVIEW"
    scene.camera.data.stereo.interocular_distance = 0.4
    bpy.ops.mesh.primitive_plane_add(size=20, location=(0, 0, -1))
    layer = scene.view_layers[0]
    layer.use_pass_position = layer.use_pass_normal = layer.use_pass_z = layer.use_pass_diffuse_color = True
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)


def show(path):
    image = bpy.data.images.load(path)
    scene = bpy.context.scene
    scene.use_nodes = True
    node = scene.node_tree.nodes.new("CompositorNodeImage")
    node.image = image
    print("SOCKETS", "stereo" if image.is_multiview else "mono", ",".join(s.name for s in node.outputs))


what, file = sys.argv[sys.argv.index("--") + 1:]
{"render": render, "show": show}[what](file)
