# SPDX-License-Identifier: CC0-1.0
"""A short shot for the farm tests: a camera that passes a few objects, as a multilayer EXR with the passes a G-buffer needs.

    blender -b --factory-startup -P tests/farm/render.py -- --out build/farm/in --frames 12
"""
import argparse
import math
import os
import sys

import bpy


def material(name, colour):
    m = bpy.data.materials.new(name)
    m.use_nodes = True
    surface = m.node_tree.nodes["Principled BSDF"]
    surface.inputs["Base Color"].default_value = (*colour, 1.0)
    surface.inputs["Roughness"].default_value = 1.0
    surface.inputs["Specular"].default_value = 0.0
    return m


def put(kind, colour, **where):
    getattr(bpy.ops.mesh, "primitive_%s_add" % kind)(**where)
    bpy.context.object.data.materials.append(material(kind, colour))


def build():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    put("plane", (0.6, 0.6, 0.58), size=12.0)
    put("cube", (0.7, 0.15, 0.1), size=1.0, location=(-0.9, 0.4, 0.5), rotation=(0.0, 0.0, 0.5))
    put("uv_sphere", (0.15, 0.4, 0.7), radius=0.6, location=(0.5, 0.1, 0.6), segments=48, ring_count=24)
    put("cylinder", (0.2, 0.55, 0.2), radius=0.25, depth=1.6, location=(1.6, 0.9, 0.8))
    put("torus", (0.7, 0.6, 0.2), major_radius=0.5, minor_radius=0.14, location=(0.1, -1.1, 0.14))
    world = bpy.data.worlds.new("World")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.7, 0.8, 1.0, 1.0)
    bpy.context.scene.world = world


def move_camera(frames):
    """A quarter of a circle around the objects, one keyframe a frame."""
    scene = bpy.context.scene
    target = bpy.data.objects.new("target", None)
    target.location = (0.2, 0.0, 0.45)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.lens = 35.0
    follow = camera.constraints.new("TRACK_TO")
    follow.target, follow.track_axis, follow.up_axis = target, "TRACK_NEGATIVE_Z", "UP_Y"
    for thing in (target, camera):
        scene.collection.objects.link(thing)
    for f in range(1, frames + 1):
        a = math.radians(-120.0 + 90.0 * (f - 1) / max(1, frames - 1))
        camera.location = (4.2 * math.cos(a), 4.2 * math.sin(a), 1.6 + 0.05 * f)
        camera.keyframe_insert("location", frame=f)
    scene.camera = camera
    scene.frame_start, scene.frame_end = 1, frames


def settings(args):
    scene, layer = bpy.context.scene, bpy.context.view_layer
    width, height = (int(v) for v in args.size.split("x"))
    scene.render.engine = "CYCLES"
    scene.cycles.samples = args.spp
    scene.cycles.seed = 1
    scene.cycles.use_denoising = False
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.film_transparent = True
    scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
    scene.render.image_settings.exr_codec = "ZIP"
    scene.render.image_settings.color_depth = "32"
    layer.use_pass_z = layer.use_pass_normal = layer.use_pass_position = True
    layer.use_pass_diffuse_color = layer.use_pass_diffuse_direct = layer.use_pass_diffuse_indirect = True
    scene.render.filepath = os.path.join(os.path.abspath(args.out), "shot.####.exr")


def main():
    parser = argparse.ArgumentParser(prog="render.py")
    parser.add_argument("--out", required=True)
    parser.add_argument("--frames", type=int, default=12)
    parser.add_argument("--size", default="240x135")
    parser.add_argument("--spp", type=int, default=4)
    args = parser.parse_args(sys.argv[sys.argv.index("--") + 1:])
    build()
    move_camera(args.frames)
    settings(args)
    bpy.ops.render.render(animation=True)


main()
