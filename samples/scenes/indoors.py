# SPDX-License-Identifier: CC0-1.0
"""still and box: rooms without a ceiling or with a hole in it."""
import math

from mathutils import Matrix, Vector

from scenes.shapes import VASE, ball, box, camera, diffuse, lathe, orbit, ring, rod, scatter, smooth_profile, span


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


def still(layout):
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


def box_room(layout):
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
