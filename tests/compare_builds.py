# compare_builds.py A.exr B.exr: prints what differs between two files and, where there are any, the previews beside them (A.png, B.png).
# Nothing is printed for files that are the same but for the attributes that name the build. Pixels are compared as they are stored; if
# these differ, build/tests/gpu/compare says by how much.
import os
import re
import struct
import sys

BUILD = (b"ssdo/version", b"ssdo/digest")


def word(data, at):
    end = data.index(b"\0", at)
    return data[at:end], end + 1


def header(data, at):
    """Attributes of one part by name, and where they end."""
    attributes = {}
    while data[at] != 0:
        name, at = word(data, at)
        kind, at = word(data, at)
        size = struct.unpack_from("<i", data, at)[0]
        attributes[name] = (kind, data[at + 4 : at + 4 + size])
        at += 4 + size
    return attributes, at + 1


def read(path):
    data = open(path, "rb").read()
    parts, at = [], 8
    multipart = struct.unpack_from("<I", data, 4)[0] & 0x1000
    while True:
        attributes, at = header(data, at)
        parts.append(attributes)
        if not multipart or data[at] == 0:
            break
    at += 1 if multipart else 0
    first = struct.unpack_from("<Q", data, at)[0]
    offsets = [offset - first for (offset,) in struct.iter_unpack("<Q", data[at:first])]
    return data[:8], parts, offsets, data[first:]


def picture(path):
    """The compressed picture of a PNG file."""
    data, at, parts = open(path, "rb").read(), 8, []
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        if kind in (b"IHDR", b"IDAT"):
            parts.append(data[at : at + 12 + size])
        at += 12 + size
    return parts


def attributes_differ(a, b):
    for part, (x, y) in enumerate(zip(a, b)):
        for name in sorted(set(x) | set(y)):
            if name not in BUILD and x.get(name) != y.get(name):
                print(f"part {part}, attribute {name.decode()}: {x.get(name)} and {y.get(name)}"[:300])
            if name in BUILD and (name in x) != (name in y):
                print(f"part {part}: only one has {name.decode()}")


def main(a, b):
    x, y = read(a), read(b)
    if x[0] != y[0] or len(x[1]) != len(y[1]):
        print("another kind of file, or of another number of parts")
    attributes_differ(x[1], y[1])
    if x[2] != y[2] or x[3] != y[3]:
        print("other pixels")
    previews = [re.sub(r"exr$", "png", path) for path in (a, b)]
    if [os.path.exists(path) for path in previews] == [True, True]:
        if picture(previews[0]) != picture(previews[1]):
            print("another preview")
    elif any(os.path.exists(path) for path in previews):
        print("only one has a preview")


main(*sys.argv[1:])
