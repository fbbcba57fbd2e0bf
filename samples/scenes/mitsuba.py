# SPDX-License-Identifier: CC0-1.0
"""Scenes of others: a Mitsuba scene.xml with meshes (as in Bitterli's rendering resources) as a scene of diffuse surfaces.

Lit by the environment alone: lamps are left out, and glass, so that light comes in through windows. Textures become one brown.
"""
import math
import os
import re
import struct
import xml.etree.ElementTree as ElementTree
import zlib

import bpy
from mathutils import Matrix, Vector

UPRIGHT = Matrix.Rotation(math.pi / 2, 4, "X")  # y up to z up
CLEAR = {"dielectric", "thindielectric", "roughdielectric", "mask"}
AROUND_ANOTHER = {"twosided", "bumpmap", "normalmap", "coating"}
TEXTURE = (0.45, 0.4, 0.35)
OTHERWISE = (0.5, 0.5, 0.5)
SMOOTH_BELOW = math.radians(35)  # between two faces


def numbers(text):
    return [float(x) for x in re.split("[, ]+", text.strip())]


def linear(hexadecimal):
    """#rrggbb, sRGB."""
    stored = [int(hexadecimal[i:i + 2], 16) / 255.0 for i in (1, 3, 5)]
    return [x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4 for x in stored]


def look_at(step):
    origin, target, up = (Vector(numbers(step.get(n))) for n in ("origin", "target", "up"))
    along = (target - origin).normalized()
    left = up.cross(along).normalized()
    columns = left, along.cross(left), along, origin
    return Matrix([[*(c[i] for c in columns)] for i in range(3)] + [[0.0, 0.0, 0.0, 1.0]])


def to_world(thing):
    matrix = Matrix.Identity(4)
    for step in thing.find("transform[@name='toWorld']") or []:
        if step.tag == "matrix":
            v = numbers(step.get("value"))
            matrix = Matrix([v[4 * i:4 * i + 4] for i in range(4)]) @ matrix
        elif step.tag == "lookat":
            matrix = look_at(step) @ matrix
        else:
            raise ValueError("toWorld: '%s' is not known, only 'matrix' and 'lookat'" % step.tag)
    return matrix


def albedo(bsdf):
    """r g b; None where one sees through it."""
    if bsdf is None:
        return OTHERWISE
    if bsdf.get("type") in CLEAR:
        return None
    if bsdf.get("type") in AROUND_ANOTHER:
        return albedo(bsdf.find("bsdf"))
    for part in bsdf:
        if part.get("name") in ("reflectance", "diffuseReflectance", "specularReflectance"):
            if part.get("value") is None:
                return TEXTURE
            values = linear(part.get("value")) if part.get("value").startswith("#") else numbers(part.get("value"))
            return tuple(min(0.9, max(0.02, x)) for x in (values if len(values) == 3 else values[:1] * 3))
    return OTHERWISE


def read_obj(path):
    points, faces = [], []
    with open(path, errors="replace") as lines:
        for line in lines:
            words = line.split()
            if words[:1] == ["v"]:
                points.append([float(x) for x in words[1:4]])
            elif words[:1] == ["f"]:
                corners = [int(w.split("/")[0]) for w in words[1:]]
                faces.append([c - 1 if c > 0 else len(points) + c for c in corners])
    return points, faces


def read_serialized(path, index):
    """One mesh of Mitsuba's own format, versions 3 and 4 (documentation of its plugin `serialized`)."""
    with open(path, "rb") as file:
        data = file.read()
    magic, version = struct.unpack_from("<HH", data)
    if magic != 0x041C or version not in (3, 4):
        raise ValueError("%s: not of version 3 or 4" % path)
    count, = struct.unpack_from("<I", data, len(data) - 4)
    start, = struct.unpack_from("<Q" if version == 4 else "<I", data, len(data) - 4 - (8 if version == 4 else 4) * (count - index))
    mesh = zlib.decompressobj().decompress(data[start + 4:])
    flags, at = struct.unpack_from("<I", mesh)[0], mesh.index(b"\0", 4) + 1 if version == 4 else 4
    points, faces = struct.unpack_from("<QQ", mesh, at)
    real, size = ("d", 8) if flags & 0x2000 else ("f", 4)
    corners = struct.unpack_from("<%d%s" % (3 * points, real), mesh, at + 16)
    at += 16 + size * points * (3 + 3 * bool(flags & 1) + 2 * bool(flags & 2) + 3 * bool(flags & 8))
    indices = struct.unpack_from("<%dI" % (3 * faces), mesh, at)
    return ([corners[3 * i:3 * i + 3] for i in range(points)], [indices[3 * i:3 * i + 3] for i in range(faces)])


def read_shape(shape, folder):
    kind = shape.get("type")
    named = shape.find("string[@name='filename']")
    if kind == "obj":
        return read_obj(os.path.join(folder, named.get("value")))
    if kind == "serialized":
        index = shape.find("integer[@name='shapeIndex']")
        return read_serialized(os.path.join(folder, named.get("value")), int(index.get("value")) if index is not None else 0)
    if kind == "rectangle":
        return [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [(0, 1, 2, 3)]
    if kind == "cube":
        corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
        return corners, [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    raise ValueError("a shape of type '%s' is not known" % kind)


def material(colour, made):
    if colour not in made:
        made[colour] = bpy.data.materials.new("diffuse")
        made[colour].use_nodes = True
        tree = made[colour].node_tree
        tree.nodes.clear()
        output, diffuse = tree.nodes.new("ShaderNodeOutputMaterial"), tree.nodes.new("ShaderNodeBsdfDiffuse")
        diffuse.inputs["Color"].default_value = (*colour, 1.0)
        tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
    return made[colour]


def add(shape, folder, colour, made):
    points, faces = read_shape(shape, folder)
    mesh = bpy.data.meshes.new("shape")
    mesh.from_pydata(points, [], faces)
    mesh.validate()
    for face in mesh.polygons:
        face.use_smooth = True
    mesh.use_auto_smooth, mesh.auto_smooth_angle = True, SMOOTH_BELOW
    mesh.materials.append(material(colour, made))
    thing = bpy.data.objects.new("shape", mesh)
    thing.matrix_world = UPRIGHT @ to_world(shape)
    bpy.context.scene.collection.objects.link(thing)


def camera(sensor):
    """Mitsuba's looks along +z with +x to the left, and its fov is that of the width."""
    data = bpy.data.cameras.new("camera")
    data.lens = 0.5 * data.sensor_width / math.tan(0.5 * math.radians(float(sensor.find("float[@name='fov']").get("value"))))
    data.clip_start, data.clip_end = 0.001, 10000.0
    thing = bpy.data.objects.new("camera", data)
    place, turn, _ = (UPRIGHT @ to_world(sensor) @ Matrix.Diagonal((-1.0, 1.0, -1.0, 1.0))).decompose()
    thing.matrix_world = Matrix.Translation(place) @ turn.to_matrix().to_4x4()
    bpy.context.scene.collection.objects.link(thing)
    bpy.context.scene.camera = thing


def load(path):
    root, folder, made = ElementTree.parse(path).getroot(), os.path.dirname(path), {}
    named = {b.get("id"): b for b in root.iter("bsdf") if b.get("id")}
    for shape in root.iter("shape"):
        reference = shape.find("ref")
        colour = albedo(named.get(reference.get("id")) if reference is not None else shape.find("bsdf"))
        if colour is not None and shape.find("emitter") is None:
            add(shape, folder, colour, made)
    camera(root.find("sensor"))
