#!/usr/bin/env python3
# SPDX-License-Identifier: CC0-1.0
"""libssdo from Python, by ctypes and numpy.

    python3 filter.py in.exr out.exr [name=value ...]   filters a file and writes what ssdo-filter would write
    python3 filter.py                                   filters a G-buffer that numpy makes, a ball on a floor

LIBSSDO names the library where the loader does not find it.
"""
import ctypes as c
import os
import sys

import numpy as np


class Channel(c.Structure):
    _fields_ = [("size", c.c_size_t), ("name", c.c_char_p), ("type", c.c_int), ("samples", c.c_void_p),
                ("pixel_stride", c.c_ssize_t), ("row_stride", c.c_ssize_t)]


class Input(c.Structure):
    _fields_ = [("size", c.c_size_t), ("files", c.POINTER(c.c_char_p)), ("file_count", c.c_int), ("width", c.c_int),
                ("height", c.c_int), ("channels", c.POINTER(Channel)), ("channel_count", c.c_int), ("attributes", c.c_void_p),
                ("attribute_count", c.c_int)]


class Layer(c.Structure):
    _fields_ = [("size", c.c_size_t), ("name", c.c_char_p), ("channels", c.c_char_p), ("view", c.c_char_p), ("width", c.c_int),
                ("height", c.c_int), ("pixels", c.POINTER(c.c_float))]


lib = c.CDLL(os.environ.get("LIBSSDO", "libssdo.so.0"))
lib.ssdo_create.restype = c.c_void_p
lib.ssdo_message.restype = c.c_char_p
for function, arguments in {"create": [c.c_void_p], "destroy": [c.c_void_p], "message": [c.c_void_p],
                            "set": [c.c_void_p, c.c_char_p, c.c_char_p], "free_frame": [c.c_void_p],
                            "filter": [c.c_void_p, c.POINTER(Input), c.POINTER(c.c_void_p)],
                            "get_layer": [c.c_void_p, c.c_int, c.POINTER(Layer)], "layer_count": [c.c_void_p],
                            "write": [c.c_void_p, c.c_void_p, c.c_char_p]}.items():
    getattr(lib, "ssdo_" + function).argtypes = arguments


class Error(Exception):
    pass


class Filter:
    """One context. Settings are the options of ssdo-filter: Filter(samples=16, env="sky.exr")."""

    def __init__(self, **settings):
        self.context = lib.ssdo_create(None)
        if not self.context:
            raise MemoryError("ssdo_create")
        for name, value in settings.items():
            self.check(lib.ssdo_set(self.context, name.replace("_", "-").encode(), str(value).encode()))

    def __del__(self):
        lib.ssdo_destroy(self.context)

    def check(self, status):
        if status:
            raise Error(lib.ssdo_message(self.context).decode())

    def _layers(self, given, path):
        frame = c.c_void_p()
        self.check(lib.ssdo_filter(self.context, c.byref(given), c.byref(frame)))
        try:
            if path:
                self.check(lib.ssdo_write(self.context, frame, os.fsencode(path)))
            layers, layer = {}, Layer(size=c.sizeof(Layer))
            for i in range(lib.ssdo_layer_count(frame)):
                lib.ssdo_get_layer(frame, i, c.byref(layer))
                shape = (layer.height, layer.width, len(layer.channels))
                layers[layer.name.decode()] = np.ctypeslib.as_array(layer.pixels, shape).copy()
            return layers
        finally:
            lib.ssdo_free_frame(frame)

    def files(self, *paths, write=None):
        """The layers of a frame in files, as arrays by name."""
        names = (c.c_char_p * len(paths))(*map(os.fsencode, paths))
        return self._layers(Input(size=c.sizeof(Input), files=names, file_count=len(paths)), write)

    def arrays(self, write=None, **passes):
        """The layers of a frame whose channels are float32 arrays: arrays(Z=depth, **{"N.X": nx})."""
        keep = {name: np.ascontiguousarray(a, np.float32) for name, a in passes.items()}
        channels = (Channel * len(keep))(*(Channel(c.sizeof(Channel), name.encode(), 2, a.ctypes.data) for name, a in keep.items()))
        height, width = next(iter(keep.values())).shape
        return self._layers(Input(size=c.sizeof(Input), width=width, height=height, channels=channels, channel_count=len(keep)), write)


def ball_on_floor(width=480, height=270, fov=40.0):
    """Depth of a ball of radius 1 on a floor, along the view axis, from a camera that looks ahead; 1e10 where nothing is."""
    x, y = np.meshgrid(np.arange(width) + 0.5 - width / 2, height / 2 - np.arange(height) - 0.5)
    focal = width / 2 / np.tan(np.radians(fov / 2))
    ray = np.stack([x / focal, y / focal, -np.ones_like(x)], -1)
    with np.errstate(divide="ignore"):
        floor = np.where(ray[..., 1] < 0, -1.5 / ray[..., 1], 1e10)
    centre = np.array([0.0, -0.5, -7.0])
    a, b = (ray * ray).sum(-1), ray @ centre
    root = b * b - a * (centre @ centre - 1.0)
    ball = np.where(root > 0, (b - np.sqrt(np.maximum(root, 0))) / a, 1e10)
    depth = np.minimum(floor, ball)
    return np.where(depth > 200, 1e10, depth)


def main():
    if len(sys.argv) < 3:
        layers = Filter(fov=40, radius=1, layers="occlusion").arrays(Z=ball_on_floor())
        print("occlusion %.4f in the mean" % layers["occlusion"].mean())
    else:
        settings = dict(a.partition("=")[::2] for a in sys.argv[3:])
        layers = Filter(**{k: v or "1" for k, v in settings.items()}).files(sys.argv[1], write=sys.argv[2])
        print("occlusion %.4f in the mean" % layers["occlusion"].mean())


if __name__ == "__main__":
    try:
        main()
    except Error as e:
        sys.exit("filter.py: %s" % e)
