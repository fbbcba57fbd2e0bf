# SPDX-License-Identifier: CC0-1.0
"""ortho, machine parts under an orthographic camera, and hot, the fixture for directions."""
import math

from mathutils import Matrix, Vector

from scenes.shapes import ball, box, camera, circle, diffuse, lathe, orbit, plate, ring, rod, scatter, solid, span
from scenes.skies import TAU, smoothstep


def ortho(layout):
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


def hot(layout):
    """The fixture for directions: a sphere, a box, a floor, one small light."""
    floor = span((-30.0, -30.0, -0.1), (30.0, 30.0, 0.0), diffuse((0.5, 0.5, 0.5)))
    layout.endless.add(floor.name)
    ball(0.8, diffuse((0.7, 0.6, 0.5)), (-0.7, 0.2, 0.0))
    box((1.0, 1.0, 1.3), diffuse((0.3, 0.5, 0.6)), (1.2, 0.6, 0.0), (0, 0, 25))
    camera((0.4, -5.6, 2.3), (0.2, 0.2, 0.6), 40.0)
