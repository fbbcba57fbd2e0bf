# SPDX-License-Identifier: CC0-1.0
"""A scene's surfaces as a mesh, and spheres for what lies beside the picture."""
import json
import math
import os

import bpy
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector

from scenes.skies import mix


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
