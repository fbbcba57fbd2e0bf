# SPDX-License-Identifier: CC0-1.0
"""Renders the sample G-buffers of this folder, their path-traced truth, their skies and scenes.json.

    blender -b --factory-startup -P samples/render.py -- --scene still --out samples
    blender -b --factory-startup -P samples/render.py -- --all --variant 7 --out /tmp/unseen
    blender -b --factory-startup -P samples/render.py -- --mitsuba living-room/scene.xml --size 240x135 --spp 48 --out /tmp/rooms

But for --mitsuba, everything is procedural and follows from (scene, variant): no assets, no numpy. Blender 3.4 with Cycles on the CPU;
oiiotool is used to cut the truth channels out of a second render and to measure its noise. See README.md.

Conventions written to scenes.json: pixels count from the top left corner, the centre of the first pixel is (0.5, 0.5);
camera space is Blender's (looks along -Z, +Y up), matrix_world is camera to world, row major, for column vectors;
env_rotate_deg turns the environment about +Z, from +X towards +Y.
"""
import argparse
import json
import math
import os
import shutil
import sys
import tempfile

import bpy
from mathutils import Matrix, Vector

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from scenes import covered, export, indoors, mitsuba, outdoors, parts, skies  # noqa: E402 (Blender's Python does not look beside the script)
from scenes.cycles import cut_truth, describe_camera, measure_noise, passes, render, scene_size, settings, world  # noqa: E402
from scenes.shapes import Layout  # noqa: E402


SKIES = {"sky_sun.exr": skies.sky_sun, "sky_soft.exr": skies.sky_soft, "hot_env.exr": skies.sky_hot}


# name: builder, sky, AO distance, transparent film
SCENES = {
    "still": (indoors.still, "sky_soft.exr", 0.5, True),
    "horizon": (outdoors.horizon, "sky_sun.exr", 2.0, False),
    "thin": (outdoors.thin, "sky_soft.exr", 0.5, True),
    "box": (indoors.box_room, "sky_soft.exr", 0.6, False),
    "ortho": (parts.ortho, "sky_sun.exr", 0.003, True),
    "room": (covered.room, "sky_sun.exr", 0.5, False),
    "corner": (covered.corner, "sky_soft.exr", 0.5, False),
    "atrium": (covered.atrium, "sky_sun.exr", 0.8, False),
    "passage": (covered.passage, "sky_soft.exr", 0.5, False),
    "engine": (covered.engine, "sky_soft.exr", 0.5, True),
    "closeup": (covered.closeup, "sky_sun.exr", 0.2, False),
    "drape": (covered.drape, "sky_soft.exr", 0.8, False),
    "hot": (parts.hot, "hot_env.exr", 1.0, False),
}
SAMPLES = ("still", "horizon", "thin", "box", "ortho")
COVERED = ("room", "corner", "atrium", "passage", "engine", "closeup")
SAMPLES_PER_PIXEL = {name: 512 if name in COVERED else 384 for name in SCENES}


def record(out, name, entry):
    path = os.path.join(out, "scenes.json")
    entries = []
    if os.path.exists(path):
        with open(path) as f:
            entries = json.load(f)
    entries = [e for e in entries if e["name"] != name] + [entry]
    order = list(SCENES)
    entries.sort(key=lambda e: (order.index(e["name"]) if e["name"] in order else len(order), e["name"]))
    with open(path, "w") as f:
        json.dump(entries, f, indent=1)
        f.write("\n")


def around(layer, path, ahead):
    """A lat-long (360 degree) G-buffer, upright, 512x256: what --also reads. From where the camera stands, or `ahead` of it: this
    share of the way to what the middle of the picture shows."""
    scene, thing = bpy.context.scene, bpy.context.scene.camera
    place, data = thing.matrix_world.translation.copy(), bpy.data.cameras.new("around")
    along = thing.matrix_world.to_quaternion() @ Vector((0.0, 0.0, -1.0))
    met, end, *_ = scene.ray_cast(bpy.context.view_layer.depsgraph, place, along)
    data.type, data.cycles.panorama_type = "PANO", "EQUIRECTANGULAR"
    scene.camera = bpy.data.objects.new("around", data)
    scene.camera.rotation_euler, scene.camera.location = (math.pi / 2, 0.0, 0.0), place.lerp(end if met else place, ahead)
    scene.collection.objects.link(scene.camera)
    scene.render.resolution_x, scene.render.resolution_y = 512, 256
    scene.cycles.samples = 8
    passes(layer, {"z", "position", "normal"})
    render(path)


def shot(name, layer, out, args):
    """The camera moves by --step and turns by --pan from frame to frame: NAME.0001.exr ..., each with its ambient occlusion by one seed, and
    NAME_truth.0001.exr ... by another."""
    scene = bpy.context.scene
    start = scene.camera.matrix_world.copy()
    for frame in range(1, args.shot + 1):
        move = Matrix.Translation((frame - 1) * Vector(args.step) + start.translation)
        scene.camera.matrix_world = move @ Matrix.Rotation(math.radians((frame - 1) * args.pan), 4, "Z") @ start.to_3x3().to_4x4()
        bpy.context.view_layer.update()
        scene.cycles.seed = args.seed
        passes(layer, {"z", "position", "normal", "ambient_occlusion"})
        render(os.path.join(out, "%s.%04d.exr" % (name, frame)))
        scene.cycles.seed = args.seed + 1000
        passes(layer, {"ambient_occlusion"})
        render(os.path.join(out, "%s_truth.%04d.exr" % (name, frame)))


def make(name, args):
    builder, env, ao_distance, transparent = SCENES[name]
    env = args.sky or env
    hot = name == "hot"
    spp = args.spp or SAMPLES_PER_PIXEL[name]
    os.makedirs(args.out, exist_ok=True)
    env_path = os.path.join(args.out, env)
    if not os.path.exists(env_path):
        SKIES[env](env_path)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    layout = Layout(name, args.variant)
    rotate = (layout.count(0, 1, 63) * 5.625 + args.turn) % 360.0  # whole texels: importance sampling stays exact
    builder(layout)
    world(env_path, rotate, hot, ao_distance)
    layer = settings(args.size, spp, args.seed, transparent, 0 if hot else 1)
    bpy.context.view_layer.update()
    if args.export_obj:
        export.export_obj(os.path.join(args.out, name + ".obj"))
    if args.export_proxies:
        export.export_proxies(layout, os.path.join(args.out, "proxies", name + ".json"))
    if args.export_obj or args.export_proxies:
        return
    if args.around:
        around(layer, os.path.join(args.out, name + "_around.exr"), 0.0)
        around(layer, os.path.join(args.out, name + "_ahead.exr"), 0.5)
        return
    if args.shot:
        shot(name, layer, args.out, args)
        return
    main, truth = os.path.join(args.out, name + ".exr"), os.path.join(args.out, name + "_truth.exr")
    if not args.truth_only:
        wanted = {"z", "position", "normal", "diffuse_color", "diffuse_direct"}
        passes(layer, wanted if hot else wanted | {"diffuse_indirect", "ambient_occlusion"})
        render(main)
    entry = {
        "name": name, "file": name + ".exr", "truth": None if hot else name + "_truth.exr", "env": env,
        "env_rotate_deg": rotate, "ao_distance": None if hot else ao_distance,
        "camera": describe_camera(bpy.context.scene.camera, args.size), "scene_size": scene_size(layout),
        "film_transparent": transparent, "size": list(args.size), "spp": spp, "seed": args.seed,
        "truth_seed": None if hot else args.seed + 1000, "truth_noise": None,
        "blender": bpy.app.version_string, "variant": args.variant,
    }
    if hot:
        entry["env_interpolation"] = "closest"
        with open(os.path.join(args.out, "hot.json"), "w") as f:
            json.dump(entry, f, indent=1)
            f.write("\n")
        return
    bpy.context.scene.cycles.seed = args.seed + 1000
    passes(layer, {"diffuse_direct", "diffuse_indirect", "ambient_occlusion"})
    folder = tempfile.mkdtemp()
    try:
        render(os.path.join(folder, "b.exr"))
        cut_truth(os.path.join(folder, "b.exr"), truth)
    finally:
        shutil.rmtree(folder)
    if os.path.exists(main):
        entry["truth_noise"] = measure_noise(main, truth)
    record(args.out, name, entry)


def main():
    parser = argparse.ArgumentParser(prog="render.py")
    parser.add_argument("--scene", choices=list(SCENES))
    parser.add_argument("--mitsuba", metavar="FILE", help="a scene.xml of somebody else, named as its folder (scenes/mitsuba.py); --sky is sky_sun.exr")
    parser.add_argument("--all", action="store_true", help="the five samples, one after the other")
    parser.add_argument("--covered", action="store_true", help="the six whose light or occlusion comes from what is not in the frame")
    parser.add_argument("--out", required=True)
    parser.add_argument("--variant", type=int, default=0, help="0: the committed layout; any other: a new one of the same kind")
    parser.add_argument("--seed", type=int, default=1, help="Cycles' sampling seed; the truth uses seed + 1000")
    parser.add_argument("--spp", type=int, default=0, help="samples per pixel; 0: the scene's own")
    parser.add_argument("--size", default=None, help="WIDTHxHEIGHT")
    parser.add_argument("--sky", choices=list(SKIES), help="light the scene by this sky instead of its own")
    parser.add_argument("--turn", type=float, default=0.0, help="turn the sky by this many degrees more, a multiple of 5.625")
    parser.add_argument("--around", action="store_true", help="render NAME_around.exr and NAME_ahead.exr, lat-long G-buffers from the camera and from ahead of it, and nothing else")
    parser.add_argument("--shot", type=int, default=0, metavar="N", help="render N frames, NAME.0001.exr ..., in which the camera moves, and nothing else")
    parser.add_argument("--pan", type=float, default=0.0, metavar="DEG", help="of --shot: how far it turns to the left from frame to frame")
    parser.add_argument("--step", type=float, nargs=3, default=(0.0, 0.0, 0.0), metavar=("X", "Y", "Z"), help="of --shot: how far the camera moves from frame to frame")
    parser.add_argument("--truth-only", action="store_true")
    parser.add_argument("--export-obj", action="store_true", help="write the scene's mesh, NAME.obj and NAME.mtl, and render nothing")
    parser.add_argument("--export-proxies", action="store_true",
                        help="write proxies/NAME.json, spheres for what lies beside the middle third of the picture, and render nothing")
    args = parser.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])
    if args.mitsuba:
        args.mitsuba = os.path.abspath(args.mitsuba)
        args.scene = os.path.basename(os.path.dirname(args.mitsuba))
        SCENES[args.scene] = (lambda layout: mitsuba.load(args.mitsuba), "sky_sun.exr", 0.5, False)
        SAMPLES_PER_PIXEL[args.scene] = SAMPLES_PER_PIXEL["room"]
    if not args.scene and not args.all and not args.covered:
        parser.error("--scene NAME, --mitsuba FILE, --all or --covered")
    names = (SAMPLES if args.all else ()) + (COVERED if args.covered else ()) or (args.scene,)
    for name in names:
        size = args.size or ("96x54" if name == "hot" else "320x180" if name in COVERED else "480x270")
        make(name, argparse.Namespace(**{**vars(args), "size": tuple(int(x) for x in size.split("x"))}))


if __name__ == "__main__":
    try:
        main()
    except Exception:
        # Blender would otherwise print the traceback and leave with 0.
        import traceback
        traceback.print_exc()
        sys.exit(1)
