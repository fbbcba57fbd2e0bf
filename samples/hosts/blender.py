# SPDX-License-Identifier: CC0-1.0
"""ssdo-filter from Blender, without an add-on: renders the passes, filters them, loads the layers into the compositor.

    blender -b --factory-startup -P samples/hosts/blender.py -- FOLDER      a few objects, 160x90, 4 samples
    blender -b scene.blend -P samples/hosts/blender.py -- FOLDER --keep     the scene of a file, as it is set up

FOLDER gets passes.exr, lit.exr, composite.png and lit.blend. SSDO names the program where it is not on the path. Run in Blender 3.4.
"""
import os
import subprocess
import sys

import bpy


def objects():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_plane_add(size=8)
    bpy.ops.mesh.primitive_cube_add(size=1, location=(-0.7, 0, 0.5))
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.6, location=(0.7, 0, 0.6))
    for thing, colour in zip(bpy.data.objects, ((0.6, 0.6, 0.6, 1), (0.7, 0.2, 0.1, 1), (0.2, 0.3, 0.7, 1))):
        material = bpy.data.materials.new(thing.name)
        material.use_nodes = True
        material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = colour
        thing.data.materials.append(material)
    bpy.ops.object.camera_add(location=(0, -5, 2.5), rotation=(1.15, 0, 0))
    scene = bpy.context.scene
    scene.camera = bpy.context.object
    scene.world = bpy.data.worlds.new("World")
    scene.world.color = (0.5, 0.5, 0.5)
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = 4, False
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 160, 90, 100


def render(path):
    scene, layer = bpy.context.scene, bpy.context.view_layer
    layer.use_pass_position = layer.use_pass_normal = layer.use_pass_z = layer.use_pass_diffuse_color = True
    scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
    scene.render.image_settings.exr_codec = "ZIP"
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    return layer.name


def compose(path, result):
    """The composite layer goes to the compositor's output; every layer is a socket of the image node."""
    scene = bpy.context.scene
    scene.use_nodes = True
    tree = scene.node_tree
    tree.nodes.clear()
    node = tree.nodes.new("CompositorNodeImage")
    node.image = bpy.data.images.load(path)
    sockets = {socket.name: socket for socket in node.outputs}
    output = tree.nodes.new("CompositorNodeComposite")
    tree.links.new(sockets["composite"], output.inputs["Image"])
    print("layers:", " ".join(name for name in sockets if name in ("occlusion", "radiance", "indirect", "composite")))
    scene.render.image_settings.file_format = "PNG"
    scene.render.filepath = result
    bpy.ops.render.render(write_still=True)


def main(arguments):
    folder = os.path.abspath(arguments[0])
    os.makedirs(folder, exist_ok=True)
    if "--keep" not in arguments:
        objects()
    passes, lit = os.path.join(folder, "passes.exr"), os.path.join(folder, "lit.exr")
    view_layer = render(passes)
    # Blender shows the passes of the view layer whose name stands before theirs.
    subprocess.run([os.environ.get("SSDO", "ssdo-filter"), "-q", passes, "-o", lit, "--prefix", view_layer + "."], check=True)
    compose(lit, os.path.join(folder, "composite.png"))
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "lit.blend"))


try:
    main(sys.argv[sys.argv.index("--") + 1:])
except Exception as error:  # Blender's exit status is 0 after a script that failed
    print("blender.py:", error, file=sys.stderr)
    sys.exit(1)
