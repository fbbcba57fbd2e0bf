# SPDX-License-Identifier: CC0-1.0
"""Cycles as the renderer of truth: its settings, passes, the camera in words, and the noise of what came out."""
import math
import os
import re
import subprocess

import bpy
from mathutils import Vector


def world(env_path, rotate_deg, closest, ao_distance):
    """The only light: a lat-long EXR, read as linear, importance-sampled at its own resolution."""
    w = bpy.data.worlds.new("World")
    bpy.context.scene.world = w
    w.use_nodes = True
    tree = w.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputWorld")
    background = tree.nodes.new("ShaderNodeBackground")
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = bpy.data.images.load(os.path.abspath(env_path))
    texture.image.colorspace_settings.name = "Non-Color"
    texture.projection = "EQUIRECTANGULAR"
    texture.interpolation = "Closest" if closest else "Linear"
    tree.links.new(texture.outputs["Color"], background.inputs["Color"])
    tree.links.new(background.outputs[0], output.inputs["Surface"])
    if rotate_deg:
        # The node turns the direction that is looked up, so the sky turns the other way.
        coordinates = tree.nodes.new("ShaderNodeTexCoord")
        mapping = tree.nodes.new("ShaderNodeMapping")
        mapping.inputs["Rotation"].default_value[2] = -math.radians(rotate_deg)
        tree.links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
        tree.links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    # AUTOMATIC takes the image's own size; MANUAL with the same width leaves fireflies around a small sun.
    w.cycles.sampling_method = "AUTOMATIC"
    w.light_settings.distance = ao_distance


def settings(size, spp, seed, transparent, bounces):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.render.film_transparent = transparent
    scene.render.use_motion_blur = False
    scene.render.threads_mode, scene.render.threads = "FIXED", 2
    scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
    scene.render.image_settings.color_depth = "16"
    scene.render.image_settings.exr_codec = "ZIP"
    scene.render.use_file_extension = False
    scene.render.use_compositing = scene.render.use_sequencer = False
    scene.render.dither_intensity = 0.0
    for stamp in ("date", "time", "render_time", "memory", "filename", "hostname"):
        setattr(scene.render, "use_stamp_" + stamp, False)  # leaves only Cycles' own times in the header
    c = scene.cycles
    c.device = "CPU"
    c.samples, c.seed = spp, seed
    c.use_adaptive_sampling = c.use_denoising = c.use_fast_gi = False
    c.max_bounces = c.diffuse_bounces = bounces
    c.glossy_bounces = c.transmission_bounces = c.volume_bounces = 0
    c.sample_clamp_direct = c.sample_clamp_indirect = 0.0
    c.light_sampling_threshold = 0.0
    c.caustics_reflective = c.caustics_refractive = False
    c.pixel_filter_type, c.filter_width = "BLACKMAN_HARRIS", 1.5
    layer = bpy.context.view_layer
    layer.name = "ViewLayer"
    return layer


def passes(layer, names):
    for p in ("z", "position", "normal", "diffuse_color", "diffuse_direct", "diffuse_indirect", "ambient_occlusion", "mist"):
        setattr(layer, "use_pass_" + p, p in names)


def render(path):
    bpy.context.scene.render.filepath = os.path.abspath(path)
    bpy.ops.render.render(write_still=True)


def describe_camera(thing, size):
    d, (w, h) = thing.data, size
    perspective = d.type == "PERSP"
    scale = d.lens / d.sensor_width * w if perspective else w / d.ortho_scale
    return {
        "type": "perspective" if perspective else "orthographic",
        "focal_px": [scale, scale] if perspective else None,
        "pixels_per_unit": None if perspective else scale,
        "principal_px": [w / 2 - d.shift_x * w, h / 2 + d.shift_y * w],
        "ortho_scale": None if perspective else d.ortho_scale,
        "matrix_world": [list(row) for row in thing.matrix_world],
        "location": list(thing.matrix_world.translation),
    }


def scene_size(layout):
    corners = [o.matrix_world @ Vector(c) for o in bpy.context.scene.objects
               if o.type == "MESH" and o.name not in layout.endless for c in o.bound_box]
    lo = [min(c[i] for c in corners) for i in range(3)]
    hi = [max(c[i] for c in corners) for i in range(3)]
    return math.dist(lo, hi)


TRUTH = ("AO.R", "DiffDir.R", "DiffDir.G", "DiffDir.B", "DiffInd.R", "DiffInd.G", "DiffInd.B")


def oiiotool(*args):
    return subprocess.run(["oiiotool", *args], check=True, stdout=subprocess.PIPE, universal_newlines=True).stdout


def cut_truth(render_path, truth_path):
    picks = ",".join("%s=ViewLayer.%s" % (c, c) for c in TRUTH)
    oiiotool(render_path, "--ch", picks, "--eraseattrib", ".*", "-d", "half", "--compression", "zip", "-o", truth_path)


def measure_noise(file_path, truth_path):
    """rms(A - B) / sqrt 2 over the pixels that hold a surface."""
    picks = ",".join("%s=ViewLayer.%s" % (c, c) for c in TRUTH)
    text = oiiotool(file_path, "--ch", picks, truth_path, "--sub", "--dup", "--mul", "-d", "float", "--printstats")
    squares = [float(x) for x in re.search(r"Stats Avg: (.*?) \(float\)", text).group(1).split()]
    text = oiiotool(file_path, "--ch", "ViewLayer.Depth.Z", "--rangecheck", "-1", "1e9")
    total = oiiotool("--info", file_path)
    width, height = (int(x) for x in re.search(r": +(\d+) x +(\d+)", total).groups())
    background = int(re.search(r"(\d+)\s+> ", text).group(1))
    share = 1.0 - background / (width * height)
    rms = lambda part: math.sqrt(sum(part) / len(part) / share / 2.0)
    return {"AO": round(rms(squares[:1]), 5), "DiffDir": round(rms(squares[1:4]), 5), "DiffInd": round(rms(squares[4:7]), 5)}
