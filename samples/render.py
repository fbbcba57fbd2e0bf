# SPDX-License-Identifier: CC0-1.0
"""Renders the sample G-buffers of this folder, their path-traced truth, their skies and scenes.json.

    blender -b --factory-startup -P samples/render.py -- --scene still --out samples
    blender -b --factory-startup -P samples/render.py -- --all --variant 7 --out /tmp/unseen

Everything is procedural and follows from (scene, variant): no assets, no numpy. Blender 3.4 with Cycles on the CPU;
oiiotool is used to cut the truth channels out of a second render and to measure its noise. See README.md.

Conventions written to scenes.json: pixels count from the top left corner, the centre of the first pixel is (0.5, 0.5);
camera space is Blender's (looks along -Z, +Y up), matrix_world is camera to world, row major, for column vectors;
env_rotate_deg turns the environment about +Z, from +X towards +Y.
"""
import argparse
import colorsys
import json
import math
import os
import random
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

import bmesh
import bpy
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Euler, Matrix, Vector, noise

TAU = 2.0 * math.pi


# ---------------------------------------------------------------- environments

def write_exr_half(path, width, height, rgb):
    """Scanline ZIP EXR with half channels R, G, B; rgb is a list of rows from the top, each a list of (r, g, b)."""
    def attr(name, kind, data):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data

    channels = b"".join(c + b"\0" + struct.pack("<iB3xii", 1, 0, 1, 1) for c in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    head = struct.pack("<ii", 20000630, 2)
    head += attr("channels", "chlist", channels) + attr("compression", "compression", b"\3")
    head += attr("dataWindow", "box2i", window) + attr("displayWindow", "box2i", window)
    head += attr("envmap", "envmap", b"\0") + attr("lineOrder", "lineOrder", b"\0")
    head += attr("pixelAspectRatio", "float", struct.pack("<f", 1.0))
    head += attr("screenWindowCenter", "v2f", struct.pack("<2f", 0.0, 0.0))
    head += attr("screenWindowWidth", "float", struct.pack("<f", 1.0)) + b"\0"
    blocks = []
    for y0 in range(0, height, 16):
        raw = b"".join(struct.pack("<%de" % width, *[p[c] for p in row])
                       for row in rgb[y0:y0 + 16] for c in (2, 1, 0))
        split = raw[0::2] + raw[1::2]
        delta = bytes([split[0]]) + bytes((b - a + 128) & 255 for a, b in zip(split, split[1:]))
        packed = zlib.compress(delta, 9)
        data = packed if len(packed) < len(raw) else raw
        blocks.append(struct.pack("<ii", y0, len(data)) + data)
    offset = len(head) + 8 * len(blocks)
    table = b""
    for block in blocks:
        table += struct.pack("<Q", offset)
        offset += len(block)
    with open(path, "wb") as f:
        f.write(head + table + b"".join(blocks))


def env_direction(u, v):
    """Blender's equirectangular mapping: u = 0.5 - atan2(y, x) / 2 pi, v from the top = acos(z) / pi."""
    azimuth, polar = (0.5 - u) * TAU, v * math.pi
    return Vector((math.sin(polar) * math.cos(azimuth), math.sin(polar) * math.sin(azimuth), math.cos(polar)))


def from_angles(azimuth_deg, elevation_deg):
    a, e = math.radians(azimuth_deg), math.radians(elevation_deg)
    return Vector((math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e)))


def smoothstep(lo, hi, x):
    t = min(1.0, max(0.0, (x - lo) / (hi - lo)))
    return t * t * (3.0 - 2.0 * t)


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def luminance(c):
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]


SUN_AZIMUTH, SUN_ELEVATION, SUN_DIAMETER = -158.0, 35.0, 1.5


def sky_sun(path, width=1024, height=512):
    """Clear sky; the sun (1.5 degrees, soft edge) holds half of the luminance that comes from the upper hemisphere."""
    sun = from_angles(SUN_AZIMUTH, SUN_ELEVATION)
    radius = math.radians(SUN_DIAMETER) / 2

    def sky(d):
        if d.z >= 0.0:
            h = (1.0 - d.z) ** 4
            base = mix((0.13, 0.26, 0.58), (0.62, 0.74, 0.90), h)
            near = max(0.0, d.dot(sun))
            glow = 0.35 * near ** 24 + 0.12 * near ** 4
            return mix(base, (1.0, 0.93, 0.80), min(1.0, glow))
        return mix((0.56, 0.55, 0.52), (0.22, 0.165, 0.115), smoothstep(0.0, 0.12, -d.z))

    rows, flux = [], 0.0
    for y in range(height):
        area = TAU / width * (math.cos(math.pi * y / height) - math.cos(math.pi * (y + 1) / height))
        row = [sky(env_direction((x + 0.5) / width, (y + 0.5) / height)) for x in range(width)]
        if y < height // 2:
            flux += area * sum(luminance(p) for p in row)
        rows.append(row)
    tint = (1.0, 0.94, 0.84)
    cover, sub, total = {}, 8, 0.0
    for y in range(height // 2):
        if abs((y + 0.5) / height * 180.0 - (90.0 - SUN_ELEVATION)) > 2.0:
            continue
        area = TAU / width * (math.cos(math.pi * y / height) - math.cos(math.pi * (y + 1) / height))
        for x in range(width):
            if env_direction((x + 0.5) / width, (y + 0.5) / height).angle(sun) > 3.0 * radius:
                continue
            share = 0.0
            for j in range(sub):
                for i in range(sub):
                    d = env_direction((x + (i + 0.5) / sub) / width, (y + (j + 0.5) / sub) / height)
                    share += 1.0 - smoothstep(0.75 * radius, 1.25 * radius, d.angle(sun))
            if share > 0.0:
                cover[x, y] = share / sub ** 2
                total += area * cover[x, y] * luminance(tint)
    strength = flux / total
    for (x, y), share in cover.items():
        rows[y][x] = tuple(p + strength * share * t for p, t in zip(rows[y][x], tint))
    write_exr_half(path, width, height, rows)


def sky_soft(path, width=512, height=256):
    """Overcast studio: grey dome, a large warm area on one side, a cool one on the other, a dim warm ground."""
    lobes = ((from_angles(-125.0, 38.0), 5.0, (2.30, 1.55, 0.85)),   # warm key, left and in front
             (from_angles(15.0, 30.0), 4.0, (0.22, 0.62, 1.35)),     # cool fill, right
             (from_angles(100.0, 62.0), 7.0, (0.75, 0.80, 0.95)))    # pale, from above and behind

    rows = []
    for y in range(height):
        row = []
        for x in range(width):
            d = env_direction((x + 0.5) / width, (y + 0.5) / height)
            dome = 0.62 * (1.0 + 2.0 * max(0.0, d.z)) / 3.0
            base = mix((0.17, 0.145, 0.12), (dome * 0.96, dome, dome * 1.05), smoothstep(-0.12, 0.12, d.z))
            for axis, sharp, colour in lobes:
                w = math.exp(sharp * (d.dot(axis) - 1.0)) * smoothstep(-0.15, 0.2, d.z)
                base = tuple(b + w * c for b, c in zip(base, colour))
            row.append(base)
        rows.append(row)
    write_exr_half(path, width, height, rows)


def sky_hot(path, width=64, height=32):
    """Black but for one texel, towards (-, -, +): wrong by one texel or mirrored, and every shadow moves."""
    rows = [[(0.0, 0.0, 0.0)] * width for _ in range(height)]
    rows[9][56] = (640.0, 600.0, 520.0)
    write_exr_half(path, width, height, rows)


# ---------------------------------------------------------------- geometry

class Layout:
    """What a scene builder works with: chance, materials, and the list of what counts for the scene's size."""

    def __init__(self, name, variant):
        self.rng = random.Random("%s:%d" % (name, variant))
        self.variant = variant
        self.endless = set()

    def pick(self, committed, lo, hi):
        """The committed value in variant 0, a random one in [lo, hi] otherwise."""
        value = self.rng.uniform(lo, hi)
        return committed if self.variant == 0 else value

    def count(self, committed, lo, hi):
        value = self.rng.randint(lo, hi)
        return committed if self.variant == 0 else value

    def flag(self, committed=False):
        value = self.rng.random() < 0.5
        return committed if self.variant == 0 else value

    def albedo(self, r, g, b):
        """The committed albedo, or one with another hue and about the same saturation and value."""
        turn, s, v = self.rng.uniform(-0.35, 0.35), self.rng.uniform(0.75, 1.2), self.rng.uniform(0.75, 1.2)
        if self.variant == 0:
            return r, g, b
        hue, sat, val = colorsys.rgb_to_hsv(r, g, b)
        return colorsys.hsv_to_rgb((hue + turn) % 1.0, min(0.85, sat * s), min(0.85, max(0.04, val * v)))

    def matte(self, r, g, b):
        return diffuse(self.albedo(r, g, b))


def diffuse(colour, second=None, pattern=None, scale=1.0):
    """A Diffuse BSDF of roughness 0: plain, or two albedos in a checker, wave (wood) or noise pattern."""
    material = bpy.data.materials.new("matte")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    bsdf = tree.nodes.new("ShaderNodeBsdfDiffuse")
    bsdf.inputs["Roughness"].default_value = 0.0
    bsdf.inputs["Color"].default_value = (*colour, 1.0)
    tree.links.new(bsdf.outputs[0], output.inputs["Surface"])
    if pattern:
        where = tree.nodes.new("ShaderNodeTexCoord").outputs["Object"]
        if pattern == "checker":
            texture = tree.nodes.new("ShaderNodeTexChecker")
            texture.inputs["Color1"].default_value = (*colour, 1.0)
            texture.inputs["Color2"].default_value = (*second, 1.0)
            tree.links.new(texture.outputs["Color"], bsdf.inputs["Color"])
        else:
            texture = tree.nodes.new("ShaderNodeTexWave" if pattern == "wave" else "ShaderNodeTexNoise")
            if pattern == "wave":
                texture.bands_direction = "Y"
                texture.inputs["Distortion"].default_value = 3.0
                texture.inputs["Detail"].default_value = 2.0
            blend = tree.nodes.new("ShaderNodeMixRGB")
            blend.inputs["Color1"].default_value = (*colour, 1.0)
            blend.inputs["Color2"].default_value = (*second, 1.0)
            tree.links.new(texture.outputs["Fac"], blend.inputs["Fac"])
            tree.links.new(blend.outputs[0], bsdf.inputs["Color"])
        texture.inputs["Scale"].default_value = scale
        tree.links.new(where, texture.inputs["Vector"])
    return material


def solid(verts, faces, material, smooth=False, at=(0, 0, 0), turn=(0, 0, 0), scale=1.0):
    """An object from vertices and faces; smooth keeps edges above 35 degrees sharp. turn is in degrees."""
    mesh = bpy.data.meshes.new("mesh")
    mesh.from_pydata([tuple(v) for v in verts], [], faces)
    mesh.validate()
    bm = bmesh.new()
    bm.from_mesh(mesh)
    bmesh.ops.recalc_face_normals(bm, faces=bm.faces)
    bm.to_mesh(mesh)
    bm.free()
    mesh.polygons.foreach_set("use_smooth", [smooth] * len(mesh.polygons))
    if smooth:
        mesh.use_auto_smooth = True
        mesh.auto_smooth_angle = math.radians(35.0)
    mesh.materials.append(material)
    thing = bpy.data.objects.new("thing", mesh)
    thing.location = at
    thing.rotation_euler = Euler([math.radians(a) for a in turn])
    thing.scale = (scale,) * 3
    bpy.context.scene.collection.objects.link(thing)
    return thing


def box(size, material, at, turn=(0, 0, 0)):
    """A box whose bottom centre is at `at`."""
    x, y, z = size[0] / 2, size[1] / 2, size[2]
    verts = [(sx * x, sy * y, h) for h in (0.0, z) for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    faces = [(3, 2, 1, 0), (4, 5, 6, 7)] + [(i, (i + 1) % 4, (i + 1) % 4 + 4, i + 4) for i in range(4)]
    return solid(verts, faces, material, at=at, turn=turn)


def span(lo, hi, material):
    """An axis-aligned box between two corners."""
    size = [h - l for l, h in zip(lo, hi)]
    return box(size, material, ((lo[0] + hi[0]) / 2, (lo[1] + hi[1]) / 2, lo[2]))


def lathe(profile, material, at, turn=(0, 0, 0), scale=1.0, segments=96):
    """Turns (radius, z) pairs about z; a radius of 0 is a pole."""
    verts, faces, rings = [], [], []
    for r, z in profile:
        n = 1 if r == 0.0 else segments
        rings.append((len(verts), n))
        verts += [(r * math.cos(TAU * i / n), r * math.sin(TAU * i / n), z) for i in range(n)]
    for (a, na), (b, nb) in zip(rings, rings[1:]):
        for i in range(segments):
            j = (i + 1) % segments
            if na == 1 and nb > 1:
                faces.append((a, b + j, b + i))
            elif nb == 1 and na > 1:
                faces.append((a + i, a + j, b))
            elif na > 1:
                faces.append((a + i, a + j, b + j, b + i))
    return solid(verts, faces, material, True, at, turn, scale)


def ball(radius, material, at):
    """A sphere resting on `at`."""
    profile = [(radius * math.sin(math.pi * i / 64) if 0 < i < 64 else 0.0, radius - radius * math.cos(math.pi * i / 64))
               for i in range(65)]
    return lathe(profile, material, at, segments=128)


def rod(radius, height, material, at, turn=(0, 0, 0), inner=0.0):
    """A cylinder standing on `at`, or a pipe."""
    if inner > 0.0:
        profile = [(inner, 0.0), (radius, 0.0), (radius, height), (inner, height), (inner, 0.0)]
    else:
        profile = [(0.0, 0.0), (radius, 0.0), (radius, height), (0.0, height)]
    return lathe(profile, material, at, turn)


def ring(major, minor, material, at, turn=(0, 0, 0)):
    """A torus lying on `at`."""
    n = 40
    profile = [(major + minor * math.cos(TAU * i / n), minor + minor * math.sin(TAU * i / n)) for i in range(n + 1)]
    return lathe(profile, material, at, turn)


def strip(points, radii, n=8):
    """Vertices and faces of a closed tube along points."""
    verts, faces = [], []
    side = None
    for k, p in enumerate(points):
        along = (points[min(k + 1, len(points) - 1)] - points[max(k - 1, 0)]).normalized()
        if side is None:
            side = along.orthogonal().normalized()
        side = (side - along * side.dot(along)).normalized()
        up = along.cross(side)
        for i in range(n):
            a = TAU * i / n
            verts.append(p + (side * math.cos(a) + up * math.sin(a)) * radii[k])
    for k in range(len(points) - 1):
        for i in range(n):
            j = (i + 1) % n
            faces.append((k * n + i, k * n + j, k * n + n + j, k * n + n + i))
    faces.append(tuple(reversed(range(n))))
    faces.append(tuple(range((len(points) - 1) * n, len(points) * n)))
    return verts, faces


class Heap:
    """Many small pieces in one mesh."""

    def __init__(self):
        self.verts, self.faces = [], []

    def add(self, verts, faces):
        base = len(self.verts)
        self.verts += verts
        self.faces += [tuple(base + i for i in f) for f in faces]

    def tube(self, points, radii, n=8):
        self.add(*strip(points, radii if isinstance(radii, (list, tuple)) else [radii] * len(points), n))

    def build(self, material, smooth=False):
        return solid(self.verts, self.faces, material, smooth)


def plate(outer, inner, thickness, material, at, turn=(0, 0, 0)):
    """Extrudes the area between two contours with the same number of points, each seen from the inner one's centre."""
    n = len(outer)
    verts = [(x, y, z) for z in (0.0, thickness) for contour in (outer, inner) for x, y in contour]
    faces = []
    for i in range(n):
        j = (i + 1) % n
        faces += [(i, j, n + j, n + i), (2 * n + i, 2 * n + j, 3 * n + j, 3 * n + i),
                  (i, j, 2 * n + j, 2 * n + i), (n + i, n + j, 3 * n + j, 3 * n + i)]
    return solid(verts, faces, material, True, at, turn)


def circle(radius, n, x=0.0, y=0.0):
    return [(x + radius * math.cos(TAU * i / n), y + radius * math.sin(TAU * i / n)) for i in range(n)]


def monkey(size, material, at, turn):
    bpy.ops.mesh.primitive_monkey_add(size=size, location=at, rotation=[math.radians(a) for a in turn])
    head = bpy.context.object
    head.modifiers.new("subdivision", "SUBSURF").render_levels = 2
    head.modifiers[0].levels = 2
    head.data.polygons.foreach_set("use_smooth", [True] * len(head.data.polygons))
    head.data.materials.append(material)
    return head


def boulder(radius, material, at, seed, rough=0.5, squash=0.7, turn=(0, 0, 0), detail=6):
    """A displaced icosphere: large lumps, ridges, then grain."""
    bm = bmesh.new()
    bmesh.ops.create_icosphere(bm, subdivisions=detail, radius=1.0)
    shift = Vector((seed * 3.17 % 91.0, seed * 7.31 % 83.0, seed * 1.93 % 97.0))
    for v in bm.verts:
        d = v.co.normalized()
        lumps = noise.noise(d * 1.1 + shift)
        ridges = 1.0 - abs(noise.noise(d * 2.3 + shift * 2.0)) * 2.0
        grain = noise.fractal(d * 5.0 + shift, 1.0, 2.1, 5)
        v.co = d * (1.0 + rough * (0.55 * lumps + 0.28 * (ridges - 0.6) + 0.07 * grain))
        v.co.z *= squash
    mesh = bpy.data.meshes.new("boulder")
    bm.to_mesh(mesh)
    bm.free()
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    mesh.materials.append(material)
    thing = bpy.data.objects.new("boulder", mesh)
    thing.location, thing.scale = at, (radius,) * 3
    thing.rotation_euler = Euler([math.radians(a) for a in turn])
    bpy.context.scene.collection.objects.link(thing)
    return thing


def far_plane(layout, material, reach=40000.0):
    """The ground to the horizon: rings that grow, so that no single face is so large that floats spoil its near part."""
    n, radii = 64, [1.5]
    while radii[-1] < reach:
        radii.append(radii[-1] * 1.8)
    verts = [(0.0, 0.0, 0.0)]
    for r in radii:
        verts += [(r * math.cos(TAU * i / n), r * math.sin(TAU * i / n), 0.0) for i in range(n)]
    faces = [(0, 1 + i, 1 + (i + 1) % n) for i in range(n)]
    for k in range(len(radii) - 1):
        a = 1 + k * n
        faces += [(a + i, a + n + i, a + n + (i + 1) % n, a + (i + 1) % n) for i in range(n)]
    ground = solid(verts, faces, material)
    layout.endless.add(ground.name)
    return ground


def scatter(rng, count, area, radius, taken, tries=400):
    """Positions of discs of a radius (a function of the index) in area (x0, y0, x1, y1) that touch none in taken."""
    found = []
    for k in range(count):
        r = radius(k)
        for _ in range(tries):
            x, y = rng.uniform(area[0] + r, area[2] - r), rng.uniform(area[1] + r, area[3] - r)
            if all((x - a) ** 2 + (y - b) ** 2 > (r + c) ** 2 for a, b, c in taken):
                taken.append((x, y, r))
                found.append((k, x, y, r))
                break
    return found


def camera(at, target, lens, roll=0.0, shift=(0.0, 0.0), ortho=None):
    data = bpy.data.cameras.new("Camera")
    thing = bpy.data.objects.new("Camera", data)
    at, target = Vector(at), Vector(target)
    look = (target - at).to_track_quat("-Z", "Y").to_matrix() @ Matrix.Rotation(math.radians(roll), 3, "Z")
    thing.matrix_world = Matrix.Translation(at) @ look.to_4x4()
    data.sensor_fit, data.sensor_width, data.lens = "HORIZONTAL", 36.0, lens
    data.shift_x, data.shift_y = shift
    data.clip_start, data.clip_end = 1e-3, 1e6
    if ortho:
        data.type, data.ortho_scale = "ORTHO", ortho
        data.clip_start = 1e-5
    bpy.context.scene.collection.objects.link(thing)
    bpy.context.scene.camera = thing
    return thing


def orbit(target, distance, azimuth, elevation):
    return Vector(target) + from_angles(azimuth, elevation) * distance


# ---------------------------------------------------------------- the scenes

VASE = [(0.0, 0.0), (0.36, 0.0), (0.40, 0.03), (0.56, 0.22), (0.66, 0.48), (0.67, 0.66), (0.58, 0.92), (0.40, 1.16),
        (0.26, 1.32), (0.22, 1.44), (0.25, 1.56), (0.36, 1.66), (0.33, 1.66), (0.21, 1.55), (0.185, 1.44), (0.23, 1.31),
        (0.36, 1.15), (0.53, 0.92), (0.62, 0.66), (0.61, 0.48), (0.50, 0.22), (0.0, 0.10)]


def smooth_profile(profile, steps=5):
    """Catmull-Rom through the profile's points."""
    out = []
    for k in range(len(profile) - 1):
        p = [Vector(profile[min(max(k + o, 0), len(profile) - 1)]) for o in (-1, 0, 1, 2)]
        for s in range(steps):
            t = s / steps
            q = 0.5 * (2 * p[1] + (p[2] - p[0]) * t + (2 * p[0] - 5 * p[1] + 4 * p[2] - p[3]) * t * t
                       + (3 * p[1] - p[0] - 3 * p[2] + p[3]) * t ** 3)
            out.append((max(q[0], 0.0) if p[1][0] or s else 0.0, q[1]))
    return out + [profile[-1]]


def books(layout, count, at, turn):
    """A pile of books: cover, pages, spine."""
    rng, z = layout.rng, at[2]
    colours = [(0.55, 0.12, 0.10), (0.12, 0.26, 0.42), (0.62, 0.52, 0.30), (0.16, 0.34, 0.20), (0.40, 0.22, 0.36)]
    paper = diffuse((0.72, 0.69, 0.60))
    for k in range(count):
        w, d, h = rng.uniform(0.42, 0.52), rng.uniform(0.30, 0.36), rng.uniform(0.05, 0.09)
        cover = layout.matte(*colours[k % len(colours)])
        angle = turn + rng.uniform(-16.0, 16.0)
        rot = Matrix.Rotation(math.radians(angle), 3, "Z")
        place = lambda x, y, dz: Vector(at[:2]).to_3d() + rot @ Vector((x, y, 0.0)) + Vector((0, 0, z + dz))
        box((w, d, 0.008), cover, place(0, 0, 0), (0, 0, angle))
        box((w, d, 0.008), cover, place(0, 0, h - 0.008), (0, 0, angle))
        box((w, 0.008, h - 0.016), cover, place(0, d / 2 - 0.004, 0.008), (0, 0, angle))
        box((w - 0.03, d - 0.02, h - 0.016), paper, place(0, 0, 0.008), (0, 0, angle))
        z += h + 0.0005
    return z


def cabinet(layout, x, back, width, depth, height, slats, upright):
    """A hollow cabinet with a slatted front and a shelf inside."""
    wood = diffuse(layout.albedo(0.46, 0.30, 0.17), layout.albedo(0.36, 0.22, 0.12), "wave", 3.0)
    t, leg = 0.03, 0.07
    x0, x1, y0, y1 = x - width / 2, x + width / 2, back - depth, back
    z0, z1 = leg, height
    span((x0, y0, z0), (x0 + t, y1, z1), wood)
    span((x1 - t, y0, z0), (x1, y1, z1), wood)
    span((x0 + t, y1 - t, z0), (x1 - t, y1, z1), wood)
    span((x0 + t, y0, z0), (x1 - t, y1 - t, z0 + t), wood)
    span((x0 - 0.03, y0 - 0.03, z1), (x1 + 0.03, y1, z1 + t), wood)
    span((x0 + t, y0 + 0.12, (z0 + z1) / 2), (x1 - t, y1 - t, (z0 + z1) / 2 + t), wood)
    for lx in (x0 + 0.06, x1 - 0.06):
        for ly in (y0 + 0.06, y1 - 0.06):
            span((lx - 0.025, ly - 0.025, 0.0), (lx + 0.025, ly + 0.025, leg), wood)
    front = diffuse(layout.albedo(0.60, 0.47, 0.30))
    if upright:
        pitch = (width - 2 * t) / slats
        for k in range(slats):
            a = x0 + t + pitch * (k + 0.25)
            span((a, y0, z0 + t), (a + pitch * 0.55, y0 + 0.025, z1), front)
    else:
        pitch = (z1 - z0 - t) / slats
        span((x - 0.02, y0 + 0.025, z0 + t), (x + 0.02, y0 + 0.05, z1), front)
        for k in range(slats):
            a = z0 + t + pitch * (k + 0.25)
            span((x0 + t, y0, a), (x1 - t, y0 + 0.025, a + pitch * 0.55), front)


def build_still(layout):
    """Indoors: floor, wall, a cabinet with a slatted front, books, sphere, vase, torus, coloured boxes in contact."""
    rng = layout.rng
    left, right, back = -2.7, layout.pick(2.35, 2.1, 2.6), 1.6
    wall_end = layout.pick(1.25, 0.7, 1.7)
    floor = diffuse(layout.albedo(0.50, 0.46, 0.41), layout.albedo(0.30, 0.27, 0.25), "checker", 2.0)
    floor_thing = span((left, -1.9, -0.12), (right, back + 0.12, 0.0), floor)
    floor_thing.location.z -= 1e-4
    plaster = layout.matte(0.66, 0.63, 0.57)
    span((left, back, 0.0), (wall_end, back + 0.12, layout.pick(2.0, 1.7, 2.3)), plaster)

    width, height = layout.pick(1.35, 1.0, 1.6), layout.pick(1.02, 0.8, 1.25)
    x = layout.pick(-1.35, -1.8, -0.9)
    cabinet(layout, x, back - 0.01, width, 0.5, height, layout.count(9, 6, 13), layout.flag(False))
    top = height + 0.03
    vase = layout.matte(0.22, 0.42, 0.44)
    lathe(smooth_profile(VASE), vase, (x - width * 0.28, back - 0.27, top), scale=layout.pick(0.36, 0.26, 0.42))
    books(layout, layout.count(3, 2, 4), (x + width * 0.18, back - 0.27, top), layout.pick(8.0, -25.0, 25.0))

    red, white = layout.matte(0.66, 0.09, 0.06), layout.matte(0.74, 0.73, 0.70)
    if layout.variant == 0:
        box((0.62, 0.62, 0.62), red, (0.18, 1.24, 0.0), (0, 0, 8))
        box((0.34, 0.34, 0.30), white, (0.20, 1.22, 0.62), (0, 0, 37))
        ball(0.36, diffuse((0.72, 0.71, 0.69)), (-0.28, 0.28, 0.0))
        ring(0.34, 0.11, diffuse((0.74, 0.50, 0.12)), (0.78, 0.32, 0.0))
        rod(0.16, 0.95, diffuse((0.30, 0.48, 0.22)), (1.42, 1.18, 0.0), inner=0.13)
        books(layout, 5, (1.55, 0.20, 0.0), -28.0)
        lathe(smooth_profile(VASE), diffuse((0.62, 0.33, 0.22)), (-1.28, 0.02, 0.0), scale=0.40)
        box((0.40, 0.05, 1.15), diffuse((0.55, 0.44, 0.31)), (0.86, 1.28, 0.0), (-14, 0, 0))
        ball(0.13, diffuse((0.15, 0.24, 0.55)), (0.55, -0.42, 0.0))
    else:
        taken = []
        side = rng.choice((-1.0, 1.0))
        bx, bs = rng.uniform(-0.1, 0.6), rng.uniform(0.45, 0.7)
        box((bs, bs, rng.uniform(0.4, 0.8)), red, (bx, back - bs * 0.62, 0.0), (0, 0, 9 * side))
        taken.append((bx, back - bs * 0.62, bs * 0.72))
        kinds = ["ball", "ring", "vase", "books", "pipe", "box", "ball", "box"]
        rng.shuffle(kinds)
        sizes = {"ball": 0.34, "ring": 0.46, "vase": 0.30, "books": 0.33, "pipe": 0.20, "box": 0.34}
        kinds = kinds[:layout.count(6, 5, 8)]
        area = (left + 0.4, -0.9, right - 0.25, back - 0.62)
        for k, px, py, r in scatter(rng, len(kinds), area, lambda i: sizes[kinds[i]], taken):
            paint = layout.matte(*rng.choice(((0.7, 0.5, 0.15), (0.2, 0.45, 0.25), (0.7, 0.7, 0.68), (0.15, 0.25, 0.55))))
            kind = kinds[k]
            if kind == "ball":
                ball(r * rng.uniform(0.5, 1.0), paint, (px, py, 0.0))
            elif kind == "ring":
                ring(r * 0.74, r * 0.25, paint, (px, py, 0.0))
            elif kind == "vase":
                lathe(smooth_profile(VASE), paint, (px, py, 0.0), scale=rng.uniform(0.3, 0.44))
            elif kind == "books":
                books(layout, rng.randint(2, 6), (px, py, 0.0), rng.uniform(-60, 60))
            elif kind == "pipe":
                rod(r * 0.8, rng.uniform(0.5, 1.1), paint, (px, py, 0.0), inner=r * 0.62)
            else:
                box((r * 1.2, r * 1.2, r * rng.uniform(0.8, 2.2)), paint, (px, py, 0.0), (0, 0, rng.uniform(0, 90)))
    target = (-0.08, 0.62, 0.55)
    camera(orbit(target, layout.pick(5.3, 4.9, 5.7), layout.pick(-71.0, -112.0, -62.0), layout.pick(15.0, 10.0, 24.0)),
           target, layout.pick(41.0, 37.0, 44.0))


def build_horizon(layout):
    """Outdoors: ground to the horizon under a sun, a colonnade, boxes, columns, a sphere, a sculpted head."""
    rng = layout.rng
    far_plane(layout, diffuse(layout.albedo(0.47, 0.42, 0.34)))
    stone = layout.matte(0.62, 0.58, 0.50)
    taken = []

    def column(x, y, height, radius):
        box((radius * 3.0, radius * 3.0, radius * 0.6), stone, (x, y, 0.0))
        profile = [(0.0, 0.0), (radius * 1.25, 0.0), (radius * 1.25, radius * 0.35), (radius, radius * 0.55),
                   (radius * 0.84, height - radius * 0.6), (radius * 1.3, height - radius * 0.1), (radius * 1.3, height), (0.0, height)]
        lathe(profile, stone, (x, y, radius * 0.6), segments=64)

    # a row of columns that carries a beam; in the committed layout one column has fallen
    n = layout.count(5, 4, 7)
    x0, y0 = layout.pick(-6.4, -9.0, -3.0), layout.pick(6.2, 4.0, 9.0)
    heading, pitch = math.radians(layout.pick(24.0, -20.0, 60.0)), layout.pick(2.1, 1.8, 2.6)
    tall, radius = layout.pick(3.6, 2.6, 4.4), 0.34
    ux, uy = math.cos(heading), math.sin(heading)
    for k in range(n):
        column(x0 + ux * pitch * k, y0 + uy * pitch * k, tall, radius)
        taken.append((x0 + ux * pitch * k, y0 + uy * pitch * k, 1.2))
    middle = (n - 1.0 - layout.count(1, 0, 1)) / 2.0
    box((pitch * 2.0 * middle + 1.1, 1.0, 0.5), stone, (x0 + ux * pitch * middle, y0 + uy * pitch * middle, tall + 0.2041),
        (0, 0, math.degrees(heading)))

    plinth = layout.matte(0.50, 0.50, 0.53)
    px, py = layout.pick(1.5, -1.0, 3.0), layout.pick(1.6, 0.5, 4.0)
    box((1.5, 1.5, 0.75), plinth, (px, py, 0.0), (0, 0, 12))
    face = math.degrees(math.atan2(py + 9.0, px - 0.8)) - 90.0
    monkey(layout.pick(1.7, 1.4, 2.0), layout.matte(0.66, 0.46, 0.32), (px, py, 1.47), (-12, 4, face + layout.pick(14.0, -40.0, 40.0)))
    taken.append((px, py, 1.6))
    size, paint = layout.pick(0.95, 0.6, 1.3), layout.matte(0.70, 0.70, 0.68)
    bx, by = layout.pick(-2.4, -4.0, -1.8), layout.pick(0.6, -1.0, 2.5)
    ball(size, paint, (bx, by, 0.0))
    taken.append((bx, by, size + 0.4))
    if layout.variant == 0:
        box((1.5, 1.5, 1.5), diffuse((0.55, 0.14, 0.09)), (4.3, 4.0, 0.0), (0, 0, 33))
        box((0.9, 0.9, 0.9), diffuse((0.20, 0.34, 0.45)), (4.15, 4.05, 1.5), (0, 0, 71))
        rod(0.30, 2.4, stone, (-0.9, -2.2, 0.30), (90, 0, 64))
        box((0.8, 0.5, 0.42), diffuse((0.30, 0.38, 0.18)), (-4.6, -1.2, 0.0), (0, 0, -25))
        box((0.5, 0.5, 0.5), diffuse((0.68, 0.55, 0.20)), (3.4, -1.9, 0.0), (0, 0, 18))
        ball(0.28, diffuse((0.15, 0.22, 0.50)), (2.5, -2.6, 0.0))
        lathe(smooth_profile(VASE), diffuse((0.60, 0.36, 0.25)), (-5.4, 2.2, 0.0), scale=0.85)
        taken += [(4.3, 4.0, 1.6), (-5.4, 2.2, 1.0)]
    for k, x, y, r in scatter(rng, layout.count(0, 5, 9), (-7.5, -3.0, 7.5, 9.0), lambda i: (0.5, 0.9, 0.4)[i % 3], taken):
        paint = layout.matte(*rng.choice(((0.55, 0.15, 0.1), (0.2, 0.35, 0.45), (0.66, 0.55, 0.2), (0.7, 0.7, 0.68))))
        if rng.random() < 0.4:
            ball(r * 0.8, paint, (x, y, 0.0))
        else:
            box((r * 1.3, r * 1.2, r * rng.uniform(0.6, 3.0)), paint, (x, y, 0.0), (0, 0, rng.uniform(0, 90)))
    # blocks and towers far away
    for k, x, y, r in scatter(rng, layout.count(26, 18, 34), (-110.0, 40.0, 120.0, 260.0), lambda i: rng.uniform(2.0, 6.0), taken):
        box((r * 1.3, r * 1.1, r * rng.uniform(0.3, 1.7)), layout.matte(*rng.choice(((0.5, 0.47, 0.42), (0.42, 0.3, 0.22), (0.55, 0.55, 0.58)))),
            (x, y, 0.0), (0, 0, rng.uniform(0, 90)))
    target = (0.1, 2.6, 1.35)
    camera(orbit(target, layout.pick(12.6, 11.5, 14.0), layout.pick(-88.0, -112.0, -68.0), layout.pick(7.0, 5.0, 13.0)),
           target, layout.pick(31.0, 28.0, 34.0))
    # In a variant the distant blocks are still spread over the same field: size is measured without them.
    for thing in list(bpy.context.scene.objects):
        if thing.type == "MESH" and thing.location.y > 14.0:
            layout.endless.add(thing.name)


def build_thin(layout):
    """Railings, leaves on twigs, a rock and pebbles on uneven ground; nothing large and flat."""
    rng = layout.rng
    shift = Vector((layout.pick(3.3, 0.0, 50.0), layout.pick(9.1, 0.0, 50.0), 0.0))

    def height(x, y):
        p = Vector((x, y, 0.0)) * 0.42 + shift
        return 0.62 * noise.noise(p) + 0.10 * noise.noise(p * 3.1) + 0.022 * noise.noise(p * 11.0) + 0.05 * y

    n, half = 220, 5.0
    verts = []
    for j in range(n + 1):
        for i in range(n + 1):
            x, y = -half + 2 * half * i / n, -half + 2 * half * j / n
            verts.append((x, y, height(x, y)))
    faces = [(j * (n + 1) + i, j * (n + 1) + i + 1, (j + 1) * (n + 1) + i + 1, (j + 1) * (n + 1) + i)
             for j in range(n) for i in range(n)]
    solid(verts, faces, diffuse(layout.albedo(0.34, 0.29, 0.20), layout.albedo(0.20, 0.26, 0.10), "noise", 1.3), True)

    # railings: posts, rails, balusters along an arc over the ground
    def railing(points, tall, material):
        heap = Heap()
        feet = [Vector((x, y, height(x, y))) for x, y in points]
        for share, radius in ((1.0, 0.026), (0.86, 0.012), (0.14, 0.012)):
            heap.tube([f + Vector((0, 0, tall * share)) for f in feet], radius, 10)
        for k, f in enumerate(feet):
            post = k % 6 == 0
            heap.tube([f - Vector((0, 0, 0.1)), f + Vector((0, 0, tall * (1.06 if post else 0.86)))], 0.03 if post else 0.0085, 10)
        heap.build(material, True)

    bend, turn = layout.pick(2.9, 2.4, 3.6), layout.pick(0.0, -0.5, 0.5)
    arc = [(layout.pick(-0.2, -0.6, 0.4) + bend * math.cos(a), 1.1 + 0.8 * bend * math.sin(a))
           for a in [math.radians(150.0 - 2.6 * k) + turn for k in range(49)]]
    railing(arc, layout.pick(0.95, 0.8, 1.1), layout.matte(0.13, 0.16, 0.19))
    fx, fy = layout.pick(0.95, 0.2, 1.2), layout.pick(-1.25, -1.6, -0.8)
    slope = math.radians(layout.pick(28.0, -10.0, 50.0))
    railing([(fx + 0.13 * k * math.cos(slope), fy + 0.13 * k * math.sin(slope)) for k in range(19)], 0.62, layout.matte(0.62, 0.57, 0.48))

    rx, ry = layout.pick(-0.95, -1.4, -0.3), layout.pick(-0.1, -0.5, 0.6)
    rock = diffuse(layout.albedo(0.46, 0.43, 0.39), layout.albedo(0.30, 0.29, 0.28), "noise", 3.0)
    boulder(layout.pick(0.68, 0.5, 0.8), rock, (rx, ry, height(rx, ry) + 0.26), layout.pick(12.0, 0.0, 900.0), 0.75, 0.8,
            (0, 0, layout.pick(30.0, 0.0, 360.0)), 7)
    taken = [(rx, ry, 0.7)]
    for k, x, y, r in scatter(rng, layout.count(26, 16, 34), (-3.2, -2.4, 3.2, 2.8), lambda i: rng.uniform(0.05, 0.2), taken):
        boulder(r, rock, (x, y, height(x, y) + r * 0.15), rng.uniform(0, 900), 0.5, 0.6, (0, 0, rng.uniform(0, 360)), 4)

    # saplings: trunk, branches, twigs, folded leaves
    wood, leaves = Heap(), Heap()

    def leaf(base, along, up, length):
        side = along.cross(up).normalized()
        fold = up * 0.28
        mid, left, right = [], [], []
        for k in range(6):
            t = k / 5
            w = length * 0.24 * math.sin(math.pi * min(1.0, t * 0.92 + 0.04)) ** 0.8
            p = base + along * (length * t) - Vector((0, 0, 0.22 * length * t * t))
            mid.append(p)
            left.append(p + (side + fold) * w)
            right.append(p + (-side + fold) * w)
        quads = [(k, k + 1, 6 + k + 1, 6 + k) for k in range(5)] + [(k, 12 + k, 12 + k + 1, k + 1) for k in range(5)]
        leaves.add(mid + left + right, quads)

    def wander(start, direction, length, steps, lift):
        points, p, d = [start], start.copy(), direction.normalized()
        for _ in range(steps):
            d = (d + Vector((rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1))) * 0.16 + Vector((0, 0, lift))).normalized()
            p = p + d * (length / steps)
            points.append(p)
        return points

    def sapling(x, y, tall, branches):
        trunk = wander(Vector((x, y, height(x, y) - 0.05)), Vector((rng.uniform(-.2, .2), rng.uniform(-.2, .2), 1)), tall, 10, 0.05)
        wood.tube(trunk, [0.045 * (1 - 0.07 * k) * tall / 2 for k in range(11)], 10)
        for b in range(branches):
            k = 3 + b * 8 // branches
            a = b * 2.4 + rng.uniform(-0.4, 0.4)
            out = Vector((math.cos(a), math.sin(a), rng.uniform(0.35, 0.8)))
            branch = wander(trunk[min(k, 10)], out, tall * rng.uniform(0.28, 0.42), 7, 0.02)
            wood.tube(branch, [0.016 * (1 - 0.1 * i) for i in range(8)], 7)
            for t in range(2, 8):
                d = (branch[t] - branch[t - 1]).normalized()
                for _ in range(2):
                    s = Vector((rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-0.3, 0.7)))
                    twig = wander(branch[t], d + s, rng.uniform(0.08, 0.2), 3, 0.0)
                    wood.tube(twig, [0.006, 0.005, 0.004, 0.003], 5)
                    for q in (1, 2, 3):
                        s = Vector((rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-0.5, 0.5)))
                        up = (Vector((0, 0, 1)) + Vector((rng.uniform(-1, 1), rng.uniform(-1, 1), 0)) * 0.6).normalized()
                        along = (d + s).normalized()
                        if abs(along.dot(up)) < 0.95:
                            leaf(twig[q], along, up, rng.uniform(0.09, 0.17))

    sapling(layout.pick(0.75, 0.4, 1.2), layout.pick(0.55, 0.2, 1.2), layout.pick(2.0, 1.5, 2.2), layout.count(9, 7, 11))
    for k in range(layout.count(1, 1, 3)):
        sapling(layout.pick(-2.1, -3.0, -1.6) + 0.8 * k, layout.pick(1.0, 0.5, 1.9), layout.pick(1.35, 0.9, 1.6), layout.count(7, 5, 8))
    wood.build(layout.matte(0.27, 0.18, 0.11), True)
    leaves.build(layout.matte(0.16, 0.36, 0.09), True)
    blades = Heap()
    for k, x, y, r in scatter(rng, layout.count(46, 30, 60), (-3.0, -2.6, 3.0, 2.2), lambda i: 0.07, taken):
        for _ in range(9):
            a, tall = rng.uniform(0, TAU), rng.uniform(0.12, 0.34)
            base = Vector((x + rng.uniform(-.05, .05), y + rng.uniform(-.05, .05), 0))
            base.z = height(base.x, base.y) - 0.01
            lean, side = Vector((math.cos(a), math.sin(a), 0)), Vector((-math.sin(a), math.cos(a), 0))
            pts = [base + Vector((0, 0, tall * t)) + lean * (0.45 * tall * t * t) for t in (0, 0.33, 0.66, 1.0)]
            wide = (0.007, 0.006, 0.004, 0.001)
            blades.add([p + side * w for p, w in zip(pts, wide)] + [p - side * w for p, w in zip(pts, wide)],
                       [(i, i + 1, 5 + i, 4 + i) for i in range(3)])
    blades.build(layout.matte(0.30, 0.40, 0.12), True)
    target = (-0.05, 0.15, 0.72)
    camera(orbit(target, layout.pick(5.2, 4.8, 5.6), layout.pick(-96.0, -125.0, -65.0), layout.pick(14.0, 10.0, 22.0)),
           target, layout.pick(40.0, 36.0, 44.0))


def build_box(layout):
    """An open box: red and green walls, two blocks, no front, part of the ceiling missing."""
    rng = layout.rng
    w, d, h, t = layout.pick(1.55, 1.2, 1.8), layout.pick(2.4, 2.0, 2.8), layout.pick(2.0, 1.7, 2.2), 0.06
    white = diffuse(layout.albedo(0.73, 0.72, 0.69))
    red, green = layout.matte(0.63, 0.06, 0.05), layout.matte(0.13, 0.45, 0.09)
    span((-w - t, 0.0, -t), (w + t, d + t, 0.0), white)
    span((-w, d, 0.0), (w, d + t, h), white)
    span((-w - t, 0.0, 0.0), (-w, d + t, h), red)
    span((w, 0.0, 0.0), (w + t, d + t, h), green)
    # the ceiling: a frame around a skylight
    x0, x1 = layout.pick(-1.05, -1.1, -0.5), layout.pick(0.95, 0.5, 1.1)
    y0, y1 = layout.pick(0.45, 0.2, 0.6), layout.pick(1.75, 1.2, 1.8)
    span((-w - t, 0.0, h), (w + t, y0, h + t), white)
    span((-w - t, y1, h), (w + t, d + t, h + t), white)
    span((-w - t, y0, h), (x0, y1, h + t), white)
    span((x1, y0, h), (w + t, y1, h + t), white)
    block = layout.matte(0.72, 0.71, 0.68)
    ax, ay = layout.pick(-0.55, -0.75, -0.4), layout.pick(1.55, 1.3, 1.65)
    bx, by = layout.pick(0.55, 0.4, 0.75), layout.pick(0.85, 0.6, 1.0)
    box((0.62, 0.62, layout.pick(1.22, 0.9, 1.4)), block, (ax, ay, 0.0), (0, 0, layout.pick(28.0, 0.0, 45.0)))
    box((0.6, 0.6, layout.pick(0.6, 0.4, 0.8)), block, (bx, by, 0.0), (0, 0, layout.pick(-18.0, -45.0, 0.0)))
    for _ in range(layout.count(0, 0, 2)):
        ball(rng.uniform(0.12, 0.22), layout.matte(0.6, 0.5, 0.2), (rng.uniform(-1.0, 1.0), rng.uniform(0.1, 0.3), 0.0))
    target = (0.0, 1.0, h * 0.5)
    camera(orbit(target, layout.pick(4.6, 4.4, 5.0), layout.pick(-90.0, -100.0, -80.0), layout.pick(0.0, -2.0, 6.0)),
           target, layout.pick(34.0, 32.0, 36.0), shift=(layout.pick(0.0, -0.03, 0.03), layout.pick(0.012, -0.02, 0.03)))


def build_ortho(layout):
    """Machine parts, millimetres as metres (the plate is about 20 mm wide), under an orthographic camera with roll."""
    rng = layout.rng
    mm = 0.001

    def gear(teeth, radius, bore, thick, material, at, turn):
        n, outer = teeth * 16, []
        for i in range(n):
            p = (i % 16) / 16.0
            lift = smoothstep(0.10, 0.26, p) - smoothstep(0.54, 0.70, p)
            r = radius * (1.0 + 0.2 * lift)
            outer.append((r * math.cos(TAU * i / n), r * math.sin(TAU * i / n)))
        plate(outer, circle(radius * 0.80, n), thick, material, at, (0, 0, turn))
        plate(circle(radius * 0.80, n), circle(radius * 0.40, n), thick * 0.55, material, (at[0], at[1], at[2] + thick * 0.2), (0, 0, turn))
        plate(circle(radius * 0.40, n), circle(bore, n), thick * 1.5, material, at, (0, 0, turn))

    def bolt(radius, length, material, at, turn, lying):
        """A hexagon head and a grooved shank; standing on its head, or lying along its axis."""
        hexa, shank = radius * 1.85, []
        z = radius * 1.2
        grooves = int((length - 0.2 * radius) / (0.32 * radius))
        for k in range(grooves):
            shank += [(radius * 0.86, z + k * 0.32 * radius), (radius, z + (k + 0.5) * 0.32 * radius)]
        end = z + grooves * 0.32 * radius
        shank += [(radius * 0.86, end), (radius * 0.7, end + 0.15 * radius), (0.0, end + 0.15 * radius)]
        turns = (90, 0, turn) if lying else (0, 0, turn)
        pose = Euler([math.radians(a) for a in turns]).to_matrix()
        base = Vector(at) + Vector((0, 0, hexa * 0.866 if lying else 0.0))
        corners = [(hexa * math.cos(TAU * (i + 0.5) / 6), hexa * math.sin(TAU * (i + 0.5) / 6)) for i in range(6)]
        if lying:
            corners = [(hexa * math.cos(TAU * i / 6), hexa * math.sin(TAU * i / 6)) for i in range(6)]
        verts = [(x, y, 0.0) for x, y in corners] + [(x, y, z) for x, y in corners]
        solid(verts, [tuple(range(6)), tuple(range(6, 12))] + [(i, (i + 1) % 6, (i + 1) % 6 + 6, i + 6) for i in range(6)],
              material, at=base, turn=turns)
        lathe([(0.0, z * 0.98), (radius * 0.86, z * 0.98)] + shank, material, base, turns)

    def bracket(size, thick, material, at, turn):
        """Two plates with holes at a right angle, and a gusset."""
        n = 64
        outer = []
        for i in range(n):
            a = TAU * i / n
            s = 1.0 / max(abs(math.cos(a)), abs(math.sin(a)))
            outer.append((size / 2 * s * math.cos(a), size / 2 * s * math.sin(a)))
        rot = Matrix.Rotation(math.radians(turn), 3, "Z")
        at = Vector(at)
        plate(outer, circle(size * 0.2, n), thick, material, at, (0, 0, turn))
        plate(outer, circle(size * 0.24, n), thick, material, at + rot @ Vector((0, size / 2 + thick, size / 2)), (90, 0, turn))
        foot = [Vector((sx * thick / 2 + size * 0.42, p, q)) for sx in (-1, 1)
                for p, q in ((size / 2, thick), (size / 2, size * 0.7), (-size * 0.2, thick))]
        solid([rot @ v for v in foot], [(0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)], material, at=at)

    base = layout.matte(0.44, 0.46, 0.48)
    span((-10.5 * mm, -7.5 * mm, -1.0 * mm), (10.5 * mm, 7.5 * mm, 0.0), base)
    steel, brass, blue = layout.matte(0.60, 0.60, 0.62), layout.matte(0.68, 0.50, 0.20), layout.matte(0.16, 0.27, 0.44)
    red, dark = layout.matte(0.58, 0.14, 0.08), layout.matte(0.20, 0.21, 0.23)
    if layout.variant == 0:
        gear(18, 3.1 * mm, 0.8 * mm, 1.3 * mm, brass, (-4.6 * mm, 0.9 * mm, 0.0), 0.0)
        gear(11, 1.9 * mm, 0.6 * mm, 1.3 * mm, steel, (0.95 * mm, 1.9 * mm, 0.0), 14.0)
        rod(0.6 * mm, 4.2 * mm, dark, (0.95 * mm, 1.9 * mm, 0.0))
        rod(0.79 * mm, 3.0 * mm, steel, (-4.6 * mm, 0.9 * mm, 0.0))
        bolt(0.8 * mm, 3.8 * mm, steel, (-1.2 * mm, -4.9 * mm, 0.0), 118.0, True)
        bolt(0.75 * mm, 2.9 * mm, dark, (4.1 * mm, -1.7 * mm, 0.0), 10.0, False)
        bracket(4.4 * mm, 0.6 * mm, blue, (6.4 * mm, 2.2 * mm, 0.0), 0.0)
        rod(1.5 * mm, 2.6 * mm, red, (6.6 * mm, -4.0 * mm, 0.0), inner=1.05 * mm)
        rod(0.7 * mm, 5.5 * mm, brass, (-9.2 * mm, -4.4 * mm, 0.7 * mm), (90, 0, 98))
        ring(0.9 * mm, 0.3 * mm, red, (-7.4 * mm, -6.0 * mm, 0.0))
        ball(0.9 * mm, diffuse((0.66, 0.66, 0.65)), (-6.7 * mm, 5.9 * mm, 0.0))
        ball(0.9 * mm, diffuse((0.66, 0.66, 0.65)), (-4.6 * mm, 6.1 * mm, 0.0))
        plate(circle(1.1 * mm, 6), circle(0.62 * mm, 6), 0.7 * mm, steel, (2.6 * mm, -5.6 * mm, 0.0), (0, 0, 20))
        plate(circle(1.1 * mm, 6), circle(0.62 * mm, 6), 0.7 * mm, steel, (9.0 * mm, -6.0 * mm, 0.0), (0, 0, 5))
    else:
        paints = [steel, brass, blue, red, dark]
        kinds = ["gear", "gear", "bracket", "lying", "standing", "pipe", "ball", "ring", "nut", "pin", "nut", "gear"]
        sizes = {"gear": 2.9, "bracket": 3.0, "lying": 2.6, "standing": 1.5, "pipe": 1.5, "ball": 1.0, "ring": 1.2, "nut": 1.1, "pin": 0.8}
        kinds = sorted(kinds[:layout.count(11, 8, 12)], key=lambda k: -sizes[k])
        for k, x, y, r in scatter(rng, len(kinds), (-10.0, -7.2, 10.0, 7.2), lambda i: sizes[kinds[i]] * 0.97, []):
            kind, paint, at, turn = kinds[k], rng.choice(paints), (x * mm, y * mm, 0.0), rng.uniform(0, 360)
            if kind == "gear":
                s = rng.uniform(0.65, 0.8)
                gear(rng.randint(9, 20), r * s * mm, 0.7 * mm, rng.uniform(0.9, 1.8) * mm, paint, at, turn)
                rod(0.69 * mm, rng.uniform(2.0, 4.5) * mm, rng.choice(paints), at)
            elif kind == "bracket":
                bracket(rng.uniform(3.4, 4.2) * mm, 0.6 * mm, paint, at, turn)
            elif kind == "lying":
                a = math.radians(turn)
                bolt(0.75 * mm, 3.2 * mm, paint, (at[0] - 2.0 * mm * math.sin(a), at[1] + 2.0 * mm * math.cos(a), 0.0), turn, True)
            elif kind == "standing":
                bolt(0.75 * mm, rng.uniform(2.0, 3.6) * mm, paint, at, turn, False)
            elif kind == "pipe":
                rod(1.4 * mm, rng.uniform(1.4, 3.4) * mm, paint, at, inner=1.0 * mm)
            elif kind == "ball":
                ball(0.9 * mm, paint, at)
            elif kind == "ring":
                ring(0.85 * mm, 0.3 * mm, paint, at)
            elif kind == "nut":
                plate(circle(1.1 * mm, 6), circle(0.62 * mm, 6), 0.7 * mm, paint, at, (0, 0, turn))
            else:
                rod(0.7 * mm, rng.uniform(2.0, 5.0) * mm, paint, at)
    target = (0.0, -0.2 * mm, 0.8 * mm)
    camera(orbit(target, 60.0 * mm, layout.pick(-76.0, -120.0, -60.0), layout.pick(46.0, 35.0, 58.0)), target, 50.0,
           roll=layout.pick(7.0, -12.0, 12.0), ortho=layout.pick(28.0, 26.5, 31.0) * mm)


def build_hot(layout):
    """The fixture for directions: a sphere, a box, a floor, one small light."""
    floor = span((-30.0, -30.0, -0.1), (30.0, 30.0, 0.0), diffuse((0.5, 0.5, 0.5)))
    layout.endless.add(floor.name)
    ball(0.8, diffuse((0.7, 0.6, 0.5)), (-0.7, 0.2, 0.0))
    box((1.0, 1.0, 1.3), diffuse((0.3, 0.5, 0.6)), (1.2, 0.6, 0.0), (0, 0, 25))
    camera((0.4, -5.6, 2.3), (0.2, 0.2, 0.6), 40.0)


# name: builder, environment, AO distance, transparent film, samples per pixel
SCENES = {
    "still": (build_still, "sky_soft.exr", 0.5, True, 384),
    "horizon": (build_horizon, "sky_sun.exr", 2.0, False, 384),
    "thin": (build_thin, "sky_soft.exr", 0.5, True, 384),
    "box": (build_box, "sky_soft.exr", 0.6, False, 384),
    "ortho": (build_ortho, "sky_sun.exr", 0.003, True, 384),
    "hot": (build_hot, "hot_env.exr", 1.0, False, 384),
}
SKIES = {"sky_sun.exr": sky_sun, "sky_soft.exr": sky_soft, "hot_env.exr": sky_hot}
SAMPLES = ("still", "horizon", "thin", "box", "ortho")


# ---------------------------------------------------------------- rendering

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


def record(out, name, entry):
    path = os.path.join(out, "scenes.json")
    entries = []
    if os.path.exists(path):
        with open(path) as f:
            entries = json.load(f)
    entries = [e for e in entries if e["name"] != name] + [entry]
    entries.sort(key=lambda e: (SAMPLES + ("hot",)).index(e["name"]))
    with open(path, "w") as f:
        json.dump(entries, f, indent=1)
        f.write("\n")


def mean_albedo(material):
    """Of a Diffuse BSDF; of a pattern, the mean of its two colours."""
    bsdf = next(n for n in material.node_tree.nodes if n.type == "BSDF_DIFFUSE").inputs["Color"]
    if not bsdf.is_linked:
        return tuple(bsdf.default_value)[:3]
    pattern = bsdf.links[0].from_node
    return mix(pattern.inputs["Color1"].default_value[:3], pattern.inputs["Color2"].default_value[:3], 0.5)


def export_obj(path):
    """The scene's surfaces for ssdo-filter --mesh: world space, Blender's axes (z up) and unit, polygons as they are, Kd in a .mtl."""
    graph = bpy.context.evaluated_depsgraph_get()
    materials, base = {}, 1
    with open(path, "w") as f:
        f.write("mtllib %s.mtl\n" % os.path.splitext(os.path.basename(path))[0])
        for thing in bpy.context.scene.objects:
            if thing.type != "MESH":
                continue
            mesh, matrix = thing.evaluated_get(graph).data, thing.matrix_world
            material = materials.setdefault(mean_albedo(mesh.materials[0]), "m%d" % len(materials))
            f.write("usemtl %s\n" % material)
            f.writelines("v %.9g %.9g %.9g\n" % tuple(matrix @ v.co) for v in mesh.vertices)
            f.writelines("f %s\n" % " ".join(str(base + i) for i in face.vertices) for face in mesh.polygons)
            base += len(mesh.vertices)
    with open(os.path.splitext(path)[0] + ".mtl", "w") as f:
        f.writelines("newmtl %s\nKd %.9g %.9g %.9g\n" % (name, *colour) for colour, name in materials.items())


# ---------------------------------------------------------------- spheres for what lies beside the picture

SPHERES_MOST = 64  # that a proxies file may hold


class Block:
    """A thing as its box in world space: low and high corner, area of its surface, albedo."""

    def __init__(self, low, high, area, albedo):
        self.low, self.high, self.area, self.albedo = low, high, area, albedo
        self.size = [max(h - l, 1e-9) for l, h in zip(low, high)]
        self.volume = self.size[0] * self.size[1] * self.size[2]
        x, y, z = self.size
        self.box_area = 2.0 * (x * y + y * z + z * x)

    def joined(self, other):
        """The two as one, of all their area, as far as the box around both can show it."""
        both = Block([min(a, b) for a, b in zip(self.low, other.low)], [max(a, b) for a, b in zip(self.high, other.high)], 0.0,
                     mix(self.albedo, other.albedo, other.area / (self.area + other.area)))
        both.area = min(self.area + other.area, both.box_area)
        return both

    def spheres(self, inside):
        """Cells of one size, a sphere in each whose shadows are in the mean as large as the cell's share of the thing. Where the
        spheres are thicker than the thing they lie behind it, as seen from the point `inside`, or a wall's would stand in the room."""
        c, b, a = sorted(self.size)
        side = max(c, b / 4.0, a / 5.0)
        counts = [max(1, round(s / side)) for s in self.size]
        radius = side * math.sqrt(1.5 / math.pi * min(1.0, self.area / self.box_area))
        thin = self.size.index(c)
        behind = math.copysign(max(0.0, radius - c / 2.0), (self.low[thin] + self.high[thin]) / 2.0 - inside[thin])
        for i in range(counts[0]):
            for j in range(counts[1]):
                for k in range(counts[2]):
                    at = [l + s * (n + 0.5) / m for l, s, n, m in zip(self.low, self.size, (i, j, k), counts)]
                    at[thin] += behind if c < side else 0.0
                    yield {"centre": [float("%.4g" % x) for x in at], "radius": float("%.3g" % radius),
                           "albedo": [round(x, 3) for x in self.albedo]}


def blocks_beside(layout, low, high):
    """What lies wholly to the left of `low` or to the right of `high` (shares of the picture's width), but for endless ground."""
    scene, graph = bpy.context.scene, bpy.context.evaluated_depsgraph_get()
    found = []
    for thing in scene.objects:
        if thing.type != "MESH" or thing.name in layout.endless:
            continue
        mesh = thing.evaluated_get(graph).data.copy()
        mesh.transform(thing.matrix_world)
        corners = [v.co for v in mesh.vertices]
        across = [world_to_camera_view(scene, scene.camera, v).x for v in corners]
        if max(across) < low or min(across) > high:
            found.append(Block([min(v[i] for v in corners) for i in range(3)], [max(v[i] for v in corners) for i in range(3)],
                               sum(p.area for p in mesh.polygons), mean_albedo(mesh.materials[0])))
        bpy.data.meshes.remove(mesh)
    return found


def join_blocks(blocks):
    """Joins what fills most of a common box: a stack of books is one block, a wall and its ceiling are two."""
    for i, a in enumerate(blocks):
        for b in blocks[i + 1:]:
            both = a.joined(b)
            if both.volume <= 1.5 * (a.volume + b.volume):
                return join_blocks([x for x in blocks if x is not a and x is not b] + [both])
    return blocks


def export_proxies(layout, path, low=1.0 / 3.0, high=2.0 / 3.0):
    """Spheres for ssdo-filter --proxies that stand for what is beside the middle of the picture; large things first."""
    spheres = []
    camera_matrix = bpy.context.scene.camera.matrix_world
    eye, ahead = camera_matrix.translation, -camera_matrix.col[2].xyz
    for block in sorted(join_blocks(blocks_beside(layout, low, high)), key=lambda b: -b.box_area):
        middle = (Vector(block.low) + Vector(block.high)) / 2.0
        more = list(block.spheres(eye + ahead * (middle - eye).dot(ahead)))
        if len(spheres) + len(more) <= SPHERES_MOST:
            spheres += more
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w") as f:
        f.write('{"spheres": [\n' + ",\n".join("  " + json.dumps(s) for s in spheres) + "\n]}\n")


def make(name, args):
    builder, env, ao_distance, transparent, spp = SCENES[name]
    hot = name == "hot"
    spp = args.spp or spp
    os.makedirs(args.out, exist_ok=True)
    env_path = os.path.join(args.out, env)
    if not os.path.exists(env_path):
        SKIES[env](env_path)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    layout = Layout(name, args.variant)
    rotate = layout.count(0, 1, 63) * 5.625  # whole texels: importance sampling stays exact
    builder(layout)
    world(env_path, rotate, hot, ao_distance)
    layer = settings(args.size, spp, args.seed, transparent, 0 if hot else 1)
    bpy.context.view_layer.update()
    if args.export_obj:
        export_obj(os.path.join(args.out, name + ".obj"))
    if args.export_proxies:
        export_proxies(layout, os.path.join(args.out, "proxies", name + ".json"))
    if args.export_obj or args.export_proxies:
        return
    main, truth = os.path.join(args.out, name + ".exr"), os.path.join(args.out, name + "_truth.exr")
    if not args.truth_only:
        wanted = {"z", "position", "normal", "diffuse_color", "diffuse_direct"}
        passes(layer, wanted if hot else wanted | {"diffuse_indirect", "ambient_occlusion"})
        render(main)
    entry = {
        "name": name, "file": name + ".exr", "truth": None if hot else name + "_truth.exr", "env": env,
        "env_rotate_deg": rotate, "ao_distance": None if hot else ao_distance,
        "camera": describe_camera(bpy.context.scene.camera, args.size), "scene_size": scene_size(layout),
        "film_transparent": transparent, "size": list(args.size), "spp": spp, "seed": args.seed,
        "truth_seed": None if hot else args.seed + 1000, "truth_noise": None,
        "blender": bpy.app.version_string, "variant": args.variant,
    }
    if hot:
        entry["env_interpolation"] = "closest"
        with open(os.path.join(args.out, "hot.json"), "w") as f:
            json.dump(entry, f, indent=1)
            f.write("\n")
        return
    bpy.context.scene.cycles.seed = args.seed + 1000
    passes(layer, {"diffuse_direct", "diffuse_indirect", "ambient_occlusion"})
    folder = tempfile.mkdtemp()
    try:
        render(os.path.join(folder, "b.exr"))
        cut_truth(os.path.join(folder, "b.exr"), truth)
    finally:
        shutil.rmtree(folder)
    if os.path.exists(main):
        entry["truth_noise"] = measure_noise(main, truth)
    record(args.out, name, entry)


def main():
    parser = argparse.ArgumentParser(prog="render.py")
    parser.add_argument("--scene", choices=list(SCENES))
    parser.add_argument("--all", action="store_true", help="the five samples, one after the other")
    parser.add_argument("--out", required=True)
    parser.add_argument("--variant", type=int, default=0, help="0: the committed layout; any other: a new one of the same kind")
    parser.add_argument("--seed", type=int, default=1, help="Cycles' sampling seed; the truth uses seed + 1000")
    parser.add_argument("--spp", type=int, default=0, help="samples per pixel; 0: the scene's own")
    parser.add_argument("--size", default=None, help="WIDTHxHEIGHT")
    parser.add_argument("--truth-only", action="store_true")
    parser.add_argument("--export-obj", action="store_true", help="write the scene's mesh, NAME.obj and NAME.mtl, and render nothing")
    parser.add_argument("--export-proxies", action="store_true",
                        help="write proxies/NAME.json, spheres for what lies beside the middle third of the picture, and render nothing")
    args = parser.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])
    if not args.scene and not args.all:
        parser.error("--scene NAME or --all")
    size = args.size or ("96x54" if args.scene == "hot" else "480x270")
    args.size = tuple(int(x) for x in size.split("x"))
    for name in SAMPLES if args.all else (args.scene,):
        make(name, args)


if __name__ == "__main__":
    try:
        main()
    except Exception:
        # Blender would otherwise print the traceback and leave with 0.
        import traceback
        traceback.print_exc()
        sys.exit(1)
