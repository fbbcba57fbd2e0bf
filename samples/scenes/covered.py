# SPDX-License-Identifier: CC0-1.0
"""Scenes whose light comes from where the frame does not look: room, corner, atrium, passage; and engine, closeup and drape,
whose occlusion comes from what it does not show."""
import math

from mathutils import Vector, noise

from scenes.shapes import VASE, Heap, ball, box, camera, diffuse, far_plane, lathe, ring, rod, scatter, smooth_profile, solid, span


def wall(axis, at, lo, hi, height, material, openings=(), thick=0.2):
    """A wall from the floor up: across `axis` (0 or 1) at the place `at`, outwards by `thick` (its sign is the way out), from lo
    to hi along the other axis; openings are (from, to, bottom, top)."""
    edges = sorted({lo, hi} | {e for o in openings for e in o[:2]})
    for a, b in zip(edges, edges[1:]):
        bottom = 0.0
        for _, _, z0, z1 in sorted((o for o in openings if o[0] <= a and b <= o[1]), key=lambda o: o[2]) + [(0, 0, height, height)]:
            if z0 > bottom:
                low, high = sorted((at, at + thick))
                if axis == 0:
                    span((low, a, bottom), (high, b, z0), material)
                else:
                    span((a, low, bottom), (b, high, z0), material)
            bottom = z1


def table(at, size, height, material):
    """A plate on four legs."""
    x, y = at
    box((size[0], size[1], 0.05), material, (x, y, height - 0.05))
    for sx in (-1, 1):
        for sy in (-1, 1):
            box((0.06, 0.06, height - 0.0501), material, (x + sx * (size[0] / 2 - 0.06), y + sy * (size[1] / 2 - 0.06), 0.0))


def sofa(layout, at, turn, material):
    """Seat, back and arms; towards -y before it is turned."""
    angle = math.radians(turn)

    def part(size, x, y, z):
        box(size, material, (at[0] + x * math.cos(angle) - y * math.sin(angle), at[1] + x * math.sin(angle) + y * math.cos(angle), z),
            (0, 0, turn))

    wide = layout.pick(1.7, 1.4, 1.9)
    part((wide, 0.75, 0.40), 0.0, 0.0, 0.04)
    part((wide, 0.20, 0.80), 0.0, 0.48, 0.04)
    for side in (-1, 1):
        part((0.18, 0.95, 0.58), side * (wide / 2 + 0.091), 0.10, 0.04)


def furnished(layout, width, depth, height, openings):
    """A room from (0, 0) to (width, depth) with a floor, a ceiling and windows in its left wall, and what stands in it."""
    floor = diffuse(layout.albedo(0.42, 0.30, 0.20), layout.albedo(0.33, 0.23, 0.15), "wave", 1.5)
    plaster, ceiling = layout.matte(0.68, 0.66, 0.61), layout.matte(0.78, 0.77, 0.74)
    span((-0.2, -0.2, -0.2), (width + 0.2, depth + 0.2, 0.0), floor)
    span((-0.2, -0.2, height), (width + 0.2, depth + 0.2, height + 0.2), ceiling)
    wall(0, 0.0, -0.2, depth + 0.2, height, plaster, openings, -0.2)
    wall(0, width, -0.2, depth + 0.2, height, layout.matte(0.60, 0.42, 0.34), (), 0.2)
    wall(1, depth, 0.0, width, height, plaster, (), 0.2)
    wall(1, 0.0, 0.0, width, height, plaster, (), -0.2)
    ground = far_plane(layout, layout.matte(0.32, 0.34, 0.22))
    ground.location.z = -0.3
    wood = layout.matte(0.45, 0.30, 0.18)
    sofa(layout, (width - 1.5, depth - 1.0), layout.pick(0.0, -12.0, 12.0), layout.matte(0.20, 0.28, 0.40))
    table((width - 1.6, depth - 2.3), (1.1, 0.7), 0.45, wood)
    lathe(smooth_profile(VASE), layout.matte(0.62, 0.33, 0.22), (width - 1.5, depth - 2.3, 0.45), scale=0.26)
    ball(0.14, layout.matte(0.68, 0.55, 0.20), (width - 1.95, depth - 2.2, 0.45))
    shelf = layout.pick(0.9, 0.7, 1.2)
    span((shelf, depth - 0.42, 0.0), (shelf + 1.1, depth - 0.01, 0.9), wood)
    box((0.32, 0.24, 0.36), layout.matte(0.66, 0.12, 0.08), (shelf + 0.3, depth - 0.2, 0.9), (0, 0, 12))
    rod(0.09, 0.5, layout.matte(0.30, 0.48, 0.22), (shelf + 0.8, depth - 0.2, 0.9), inner=0.07)
    rod(0.02, 1.55, layout.matte(0.2, 0.2, 0.22), (width - 0.45, depth - 2.2, 0.0))
    rod(0.19, 0.28, layout.matte(0.75, 0.70, 0.58), (width - 0.45, depth - 2.2, 1.5), inner=0.18)
    rug = layout.matte(0.50, 0.16, 0.14)
    box((1.9, 1.4, 0.02), rug, (width - 1.7, depth - 2.2, 0.0), (0, 0, layout.pick(4.0, -10.0, 10.0)))


def room(layout):
    """A living room lit through two windows in the left wall; ceiling and one window are in view."""
    width, depth, height = layout.pick(4.6, 4.2, 5.2), layout.pick(5.4, 5.0, 6.0), layout.pick(2.6, 2.5, 2.8)
    near, far = layout.pick(0.8, 0.5, 1.0), layout.pick(3.0, 2.8, 3.3)
    furnished(layout, width, depth, height, [(near, near + 1.1, 0.9, 2.2), (far, far + 1.2, 0.9, 2.2)])
    camera((width - layout.pick(0.7, 0.5, 1.2), 0.35, layout.pick(1.45, 1.3, 1.6)),
           (width * layout.pick(0.42, 0.36, 0.5), depth, layout.pick(1.25, 1.15, 1.4)), layout.pick(24.0, 22.0, 26.0))


def corner(layout):
    """The same kind of room, seen from above the table: neither the ceiling nor a window is in view."""
    width, depth, height = layout.pick(4.4, 4.2, 5.0), layout.pick(5.0, 4.8, 5.6), layout.pick(2.7, 2.5, 2.9)
    near = layout.pick(0.5, 0.3, 0.7)
    furnished(layout, width, depth, height, [(near, near + 1.8, 0.4, 2.4), (near + 2.1, near + 3.7, 0.4, 2.4)])
    camera((layout.pick(1.5, 1.2, 1.9), depth - layout.pick(3.9, 3.7, 4.1), layout.pick(1.9, 1.75, 2.05)),
           (width - layout.pick(1.4, 1.2, 1.7), depth - 1.5, 0.35), layout.pick(33.0, 30.0, 36.0))


def atrium(layout):
    """A court between galleries, open to the sky above the frame; the camera stands under one gallery."""
    stone, floor = layout.matte(0.60, 0.55, 0.47), diffuse(layout.albedo(0.46, 0.42, 0.37), layout.albedo(0.36, 0.33, 0.30), "checker", 1.0)
    half, storey, deep = layout.pick(3.6, 3.2, 4.2), layout.pick(2.9, 2.7, 3.2), layout.pick(2.2, 2.0, 2.6)
    outer, top = half + deep, 2.0 * storey + 0.6
    span((-outer - 0.3, -outer - 0.3, -0.3), (outer + 0.3, outer + 0.3, 0.0), floor)
    plaster = layout.matte(0.66, 0.52, 0.40)
    for side in (-1, 1):
        wall(0, side * outer, -outer, outer, top, plaster, (), side * 0.3)
        wall(1, side * outer, -outer - 0.3, outer + 0.3, top, plaster, (), side * 0.3)
    for k in (1, 2):  # the gallery's floor, then its roof: a frame around the court
        z = k * storey
        for side in (-1, 1):
            span(*sorted_corners((side * half, -outer, z), (side * outer, outer, z + 0.25)), stone)
            span(*sorted_corners((-half, side * half, z), (half, side * outer, z + 0.25)), stone)
    count = layout.count(4, 3, 5)
    for k in range(count + 1):
        p = -half + 2.0 * half * k / count
        for x, y in {(p, -half), (p, half), (-half, p), (half, p)}:
            for base in (0.0, storey + 0.2501):
                rod(0.16, storey - 0.0002 if base == 0.0 else storey - 0.2503, stone, (x, y, base))
    cloth = layout.matte(0.55, 0.10, 0.08)
    for x in (-half * 0.45, half * layout.pick(0.4, 0.2, 0.6)):
        curtain(cloth, (x - 0.7, half + 0.25), (x + 0.7, half + 0.25), 0.3, storey - 0.02, layout)
    ring(0.9, 0.22, stone, (layout.pick(0.3, -0.6, 0.8), layout.pick(0.4, -0.3, 1.0), 0.0))
    lathe(smooth_profile(VASE), layout.matte(0.30, 0.36, 0.28), (-1.9, layout.pick(1.4, 0.6, 2.0), 0.0), scale=0.7)
    box((0.8, 0.8, 0.6), layout.matte(0.22, 0.33, 0.45), (2.1, layout.pick(-0.6, -1.2, 0.8), 0.0), (0, 0, 25))
    camera((layout.pick(1.2, -1.6, 1.6), -half - deep * 0.6, 1.6), (layout.pick(-0.4, -0.8, 0.8), half, layout.pick(1.75, 1.6, 1.9)),
           layout.pick(26.0, 24.0, 28.0))


def sorted_corners(a, b):
    return tuple(map(min, a, b)), tuple(map(max, a, b))


def curtain(material, start, end, bottom, top, layout, folds=7):
    """Hanging cloth without a thickness, in folds from start to end (x, y)."""
    n, shift = folds * 10, layout.rng.uniform(0.0, math.tau)
    a, b = Vector((*start, 0.0)), Vector((*end, 0.0))
    across = (b - a).normalized().cross(Vector((0, 0, 1)))
    deep = 0.28 * (b - a).length / folds
    verts = []
    for z, share in ((bottom, 1.0), ((bottom + top) / 2, 0.8), (top, 0.5)):
        for i in range(n + 1):
            p = a.lerp(b, i / n) + across * (deep * share * math.sin(math.tau * folds * i / n + shift))
            verts.append((p.x, p.y, z))
    faces = [(r * (n + 1) + i, r * (n + 1) + i + 1, (r + 1) * (n + 1) + i + 1, (r + 1) * (n + 1) + i) for r in range(2) for i in range(n)]
    return solid(verts, faces, material, True)


def passage(layout):
    """A covered passage with openings to the right behind hanging cloth; the ceiling and the far, closed end are in view."""
    wide, long, height = layout.pick(2.6, 2.3, 3.0), layout.pick(11.0, 9.0, 13.0), layout.pick(3.0, 2.8, 3.3)
    floor = diffuse(layout.albedo(0.48, 0.40, 0.32), layout.albedo(0.36, 0.29, 0.23), "checker", 1.3)
    plaster = layout.matte(0.64, 0.58, 0.48)
    span((-0.3, -1.0, -0.2), (wide + 0.3, long + 0.3, 0.0), floor)
    span((-0.3, -1.0, height), (wide + 0.3, long + 0.3, height + 0.3), layout.matte(0.55, 0.48, 0.40))
    wall(0, 0.0, -1.0, long, height, plaster, (), -0.3)
    wall(1, long, -0.3, wide + 0.3, height, layout.matte(0.40, 0.46, 0.50), (), 0.3)
    wall(1, -0.7, 0.0, wide, height, plaster, (), -0.3)
    first, pitch = layout.pick(1.4, 1.0, 1.8), layout.pick(2.4, 2.2, 2.7)
    doors = [(first + pitch * k, first + pitch * k + 1.15, 0.0, 2.3) for k in range(int((long - first - 1.5) / pitch) + 1)]
    wall(0, wide, -1.0, long, height, plaster, doors, 0.3)
    ground = far_plane(layout, layout.matte(0.50, 0.45, 0.36))
    ground.location.z = -0.25
    cloth = (layout.matte(0.62, 0.14, 0.10), layout.matte(0.16, 0.30, 0.46), layout.matte(0.66, 0.52, 0.20))
    for k, (y0, y1, _, top) in enumerate(doors):
        curtain(cloth[k % 3], (wide - 0.12, y0 - 0.05), (wide - 0.12, y0 + 0.75), 0.12, top + 0.15, layout, 5)
    curtain(cloth[1], (0.15, long * 0.6), (wide * 0.45, long * 0.6), 0.1, height - 0.02, layout, 6)
    box((0.6, 0.6, 0.7), layout.matte(0.45, 0.30, 0.18), (0.5, layout.pick(3.4, 2.8, 4.0), 0.0), (0, 0, 15))
    lathe(smooth_profile(VASE), layout.matte(0.60, 0.36, 0.25), (0.6, layout.pick(5.2, 4.6, 5.6), 0.0), scale=0.5)
    camera((wide * layout.pick(0.45, 0.4, 0.55), -0.4, layout.pick(1.5, 1.4, 1.65)), (wide * 0.5, long, layout.pick(1.45, 1.3, 1.6)),
           layout.pick(27.0, 25.0, 30.0))


def drape(layout):
    """Pillars before a wall, a curtain beside the right one, at the border: for --shot with --pan, which takes the curtain out of the frame."""
    stone, plaster = layout.matte(0.50, 0.46, 0.40), layout.matte(0.64, 0.58, 0.48)
    span((-6.0, -4.0, -0.2), (6.0, 5.0, 0.0), layout.matte(0.42, 0.34, 0.27))
    span((-6.0, 4.5, 0.0), (6.0, 4.7, 4.0), plaster)
    side = layout.pick(0.5, 0.45, 0.55)
    for x in (-2.2, -0.7, 0.85):
        span((x - side / 2, 1.75, 0.0), (x + side / 2, 1.75 + side, 4.0), stone)
    for y in (0.9, 2.4):
        curtain(layout.matte(0.62, 0.14, 0.10), (1.28, y), (1.28, y + 0.8), 0.0, 3.2, layout, 5)
    lathe(smooth_profile(VASE), layout.matte(0.60, 0.36, 0.25), (0.1, layout.pick(1.2, 1.0, 1.4), 0.0), scale=0.5)
    camera((-0.6, -1.6, layout.pick(1.4, 1.3, 1.5)), (0.4, 4.5, 1.2), layout.pick(27.0, 26.0, 28.0))


def engine(layout):
    """Blocks, pipes and ribs over one another with deep gaps: cavities whose backs and floors are hidden."""
    rng = layout.rng
    steel, dark, brass = layout.matte(0.52, 0.52, 0.54), layout.matte(0.22, 0.23, 0.25), layout.matte(0.60, 0.44, 0.20)
    paints = (steel, dark, brass, layout.matte(0.50, 0.13, 0.09), layout.matte(0.16, 0.26, 0.42))
    span((-3.0, -2.2, -0.3), (3.0, 2.2, 0.0), dark)
    # two rows of cylinders with cooling ribs, a gap between the rows
    count = layout.count(5, 4, 6)
    pitch = 4.6 / count
    for row in (-1, 1):
        for k in range(count):
            x, y = -2.3 + pitch * (k + 0.5), row * layout.pick(0.75, 0.65, 0.85)
            rod(pitch * 0.30, 1.25, steel, (x, y, 0.0))
            for r in range(7):
                rod(pitch * 0.46, 0.05, dark, (x, y, 0.18 + 0.15 * r), inner=pitch * 0.29)
            box((pitch * 0.8, 0.55, 0.3), rng.choice(paints), (x, y, 1.2501), (0, 0, rng.uniform(-4, 4)))
    # pipes along and across, one above the other
    pipes = Heap()
    for k in range(layout.count(9, 7, 11)):
        x = -2.5 + 5.0 * k / 9 + rng.uniform(-0.15, 0.15)
        z = rng.uniform(0.9, 1.5)
        points = [Vector((x, y, z + 0.35 * math.cos(1.3 * y))) for y in [-1.5 + 0.15 * i for i in range(21)]]
        pipes.tube(points, rng.uniform(0.05, 0.10), 20)
    pipes.build(brass, True)
    for k in range(3):
        y = (-0.2, 0.0, 0.22)[k]
        rod(0.09, 5.2, paints[k], (-2.6, y, 0.35 + 0.3 * k), (0, 90, 0))
    # an open frame in front, and plates behind
    for x in (-2.4, -0.8, 0.8, 2.4):
        span((x - 0.08, -1.75, 0.0), (x + 0.08, -1.55, 1.6), steel)
    span((-2.6, -1.76, 0.75), (2.6, -1.60, 0.95), steel)
    for k in range(6):
        span((-2.6 + 0.9 * k, 1.55 + 0.03 * k, 0.0), (-1.9 + 0.9 * k, 1.62 + 0.03 * k, rng.uniform(1.3, 2.0)), paints[k % 5])
    for k, x, y, r in scatter(rng, 10, (-2.8, -2.1, 2.8, -1.8), lambda i: 0.09, []):
        ball(r, paints[k % 5], (x, y, 0.0))
    camera((layout.pick(1.4, -1.8, 1.8), -4.6, layout.pick(2.5, 2.2, 2.9)), (0.0, 0.0, 0.75), layout.pick(34.0, 31.0, 37.0))


def closeup(layout):
    """A still life from near: twigs, wires and cups before one another, each outline a step in depth."""
    rng = layout.rng
    ground = layout.matte(0.45, 0.40, 0.33)
    span((-3.0, -2.0, -0.1), (3.0, 4.0, 0.0), ground)
    span((-3.0, 3.9, 0.0), (3.0, 4.0, 2.4), layout.matte(0.58, 0.60, 0.62))
    paints = [layout.matte(*c) for c in ((0.62, 0.16, 0.10), (0.18, 0.34, 0.20), (0.66, 0.54, 0.22), (0.20, 0.28, 0.50), (0.70, 0.68, 0.64))]
    taken = []
    for k, x, y, r in scatter(rng, layout.count(9, 7, 11), (-0.9, 0.1, 0.9, 1.6), lambda i: (0.16, 0.10, 0.13)[i % 3], taken):
        kind = k % 4
        if kind == 0:
            lathe(smooth_profile(VASE), paints[k % 5], (x, y, 0.0), scale=r * 1.5)
        elif kind == 1:
            rod(r, r * 2.6, paints[k % 5], (x, y, 0.0), inner=r * 0.85)
        elif kind == 2:
            ball(r, paints[k % 5], (x, y, 0.0))
        else:
            box((r * 1.3, r * 1.3, r * 2.2), paints[k % 5], (x, y, 0.0), (0, 0, rng.uniform(0, 90)))
    wires = Heap()
    for k in range(layout.count(30, 24, 36)):
        p, points = Vector((rng.uniform(-0.8, 0.8), rng.uniform(-0.35, 0.5), 0.0)), []
        lean = Vector((rng.uniform(-0.3, 0.3), rng.uniform(-0.2, 0.2), 1.0)).normalized()
        tall = rng.uniform(0.35, 0.75)
        for i in range(12):
            bend = noise.noise_vector(p * 2.0 + Vector((0, 0, i * 0.2))) * 0.05
            points.append(p + lean * (tall * i / 11) + bend * (i / 11))
        wires.tube(points, [0.011 - 0.0006 * i for i in range(12)], 10)
    wires.build(layout.matte(0.25, 0.19, 0.13), True)
    camera((layout.pick(0.15, -0.3, 0.3), -1.35, layout.pick(0.55, 0.45, 0.7)), (0.0, 0.7, 0.28), layout.pick(36.0, 33.0, 40.0))
