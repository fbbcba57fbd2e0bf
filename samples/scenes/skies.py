# SPDX-License-Identifier: CC0-1.0
"""The skies of the samples: lat-long maps by formula, and the EXR writer for them."""
import math
import struct
import zlib

from mathutils import Vector


TAU = 2.0 * math.pi


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
