# SPDX-License-Identifier: CC0-1.0
"""horizon and thin: ground to the horizon; railings, leaves and stones."""
import math

import bpy
from mathutils import Vector, noise

from scenes.shapes import (
    Heap, VASE, ball, boulder, box, camera, diffuse, far_plane, lathe, monkey, orbit, rod, scatter, smooth_profile, solid)
from scenes.skies import TAU


def horizon(layout):
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


def thin(layout):
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
