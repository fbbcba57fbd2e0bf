# SPDX-License-Identifier: CC0-1.0
"""What the scenes are built of: chance, materials, solids, the camera."""
import colorsys
import math
import random

import bmesh
import bpy
from mathutils import Euler, Matrix, Vector, noise

from scenes.skies import TAU, from_angles


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
    if smooth and hasattr(mesh, "set_sharp_from_angle"):  # Blender 4.1 and later
        mesh.set_sharp_from_angle(angle=math.radians(35.0))
    elif smooth:
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
