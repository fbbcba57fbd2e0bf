// What is known of renderers' files: names, spaces, depth, backgrounds, attributes. See renderer_file.h.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "renderer_file.h"

static exrio_out_attr text(const char *name, const char *value)
{
    return (exrio_out_attr){.name = name, .kind = EXRIO_OUT_STRING, .string = value};
}
static exrio_out_attr number(const char *name, double value)
{
    return (exrio_out_attr){.name = name, .kind = EXRIO_OUT_FLOAT, .number = value};
}

// Row vectors: v * M. The rows of a camera-to-world matrix are the camera's axes and its place.
static exrio_out_attr camera_to_world(const char *name, vec3 x, vec3 y, vec3 z, vec3 eye)
{
    const vec3 rows[4] = {x, y, z, eye};
    exrio_out_attr a = {.name = name, .kind = EXRIO_OUT_M44};
    for (int r = 0; r < 4; r++) a.m44[r][0] = rows[r].x, a.m44[r][1] = rows[r].y, a.m44[r][2] = rows[r].z, a.m44[r][3] = r == 3;
    return a;
}

// Its inverse: the columns are the axes.
static exrio_out_attr world_to_camera(vec3 x, vec3 y, vec3 z, vec3 eye)
{
    const vec3 axes[3] = {x, y, z};
    exrio_out_attr a = {.name = "worldToCamera", .kind = EXRIO_OUT_M44};
    for (int c = 0; c < 3; c++)
        a.m44[0][c] = axes[c].x, a.m44[1][c] = axes[c].y, a.m44[2][c] = axes[c].z, a.m44[3][c] = -v3_dot(axes[c], eye);
    a.m44[3][3] = 1;
    return a;
}

// Columns: what x, y and w become.
static exrio_out_attr world_to_ndc(const fact_camera *c, double x, double y, double w)
{
    const exrio_out_attr m = world_to_camera(c->right, c->up, c->forward, c->eye);
    exrio_out_attr a = {.name = "worldToNDC", .kind = EXRIO_OUT_M44};
    for (int r = 0; r < 4; r++) {
        a.m44[r][0] = x * c->cot_x * m.m44[r][0], a.m44[r][1] = y * c->cot_y * m.m44[r][1];
        a.m44[r][2] = a.m44[r][3] = w * m.m44[r][2];
    }
    return a;
}

static int of_blender(const fact_camera *c, exrio_out_attr *a, char (*texts)[32])
{
    (void)c, (void)texts;
    a[0] = text("BlenderMultiChannel", "Blender V2.55.1 and newer"), a[1] = text("Camera", "Camera");
    return 2;
}

// Clip space, -1..1 with y up, and a camera that looks along +z.
static int of_arnold(const fact_camera *c, exrio_out_attr *a, char (*texts)[32])
{
    (void)texts;
    a[0] = world_to_camera(c->right, c->up, c->forward, c->eye), a[1] = world_to_ndc(c, 1, 1, 1);
    a[2] = number("CameraFov", c->fov_degrees), a[3] = number("arnold/camera/near_clip", 0.1);
    a[4] = text("arnold/aovs/P/filter", "closest_filter");
    return 5;
}

static int of_renderman(const fact_camera *c, exrio_out_attr *a, char (*texts)[32])
{
    (void)texts;
    a[0] = world_to_camera(c->right, c->up, c->forward, c->eye), a[1] = world_to_ndc(c, 0.5, -0.5, 1);
    for (int r = 0; r < 4; r++) // to 0..1, y down
        for (int k = 0; k < 2; k++) a[1].m44[r][k] += 0.5 * a[1].m44[r][3];
    return 2;
}

// The rotation needs an axis swap: in the Cornell sample -z points straight up.
static int of_vray(const fact_camera *c, exrio_out_attr *a, char (*texts)[32])
{
    (void)texts;
    a[0] = camera_to_world("cameraTransform", c->right, v3_scale(c->forward, -1), v3_scale(c->up, -1), c->eye);
    a[1] = number("cameraFov", c->fov_degrees), a[2] = text("vrayInfo/vrayversion", "V-Ray");
    return 3;
}

static int of_redshift(const fact_camera *c, exrio_out_attr *a, char (*texts)[32])
{
    (void)texts;
    a[0] = camera_to_world("rs/camera/transform", c->right, c->up, v3_scale(c->forward, -1), c->eye);
    a[1] = number("rs/camera/fov", c->fov_degrees / 57.29577951308232), a[2] = number("rs/camera/nearPlane", 0.1);
    return 3;
}

// w = -z and a mirrored x.
static int of_mantra(const fact_camera *c, exrio_out_attr *a, char (*texts)[32])
{
    (void)texts;
    a[0] = world_to_camera(c->right, c->up, c->forward, c->eye), a[1] = world_to_ndc(c, -1, 1, -1);
    return 2;
}

static int of_karma(const fact_camera *c, exrio_out_attr *a, char (*texts)[32])
{
    (void)c, (void)texts;
    a[0] = text("husk:render_stats", "{}");
    return 1;
}

// All attributes are texts.
static int of_unreal(const fact_camera *c, exrio_out_attr *a, char (*texts)[32])
{
    static const char *const names[] = {"unreal/camera/curRot/yaw",    "unreal/camera/curRot/pitch", "unreal/camera/curRot/roll",
                                        "unreal/camera/curPos/x",      "unreal/camera/curPos/y",     "unreal/camera/curPos/z",
                                        "unreal/camera/FinalImage/fov"};
    const double degrees = 57.29577951308232;
    const double values[] = {degrees * atan2(c->forward.y, c->forward.x),
                             degrees * asin(c->forward.z),
                             degrees * atan2(-c->right.z, c->up.z),
                             c->eye.x,
                             c->eye.y,
                             c->eye.z,
                             c->fov_degrees};
    for (int i = 0; i < 7; i++) {
        snprintf(texts[i], sizeof texts[i], "%.9g", values[i]);
        a[i] = text(names[i], texts[i]);
    }
    return 7;
}

static int of_luxcore(const fact_camera *c, exrio_out_attr *a, char (*texts)[32])
{
    (void)c, (void)texts;
    (void)a;
    return 0;
}

const renderer_fact renderer_facts[] = {
    {"blender", "measured on Blender 3.4 render output", "ViewLayer.Position:XYZ", "ViewLayer.Normal:XYZ", "ViewLayer.Depth:Z",
     "ViewLayer.DiffCol:RGB", "ViewLayer.Combined:RGBA", .half_colours = true, .background_depth = 1e10,
     .attributes = of_blender},
    {"blender", "measured on Blender 3.4's File Output node", "Position:XYZ", "Normal:XYZ", "Depth:V", "DiffCol:RGB",
     "Image:RGBA", .background_depth = 1e10},
    {"blender", "Blender source: the newer pass names", "ViewLayer.Position:XYZ", "ViewLayer.Normal:XYZ", "ViewLayer.Depth:Z",
     "ViewLayer.Diffuse Color:RGB", "ViewLayer.Combined:RGBA", .background_depth = 1e10, .attributes = of_blender},
    {"arnold", "header of Psyop's multichannel.exr; Arnold developer guide", "P:XYZ", "N:XYZ", "Z", "albedo:RGB", ":RGBA",
     .world = WORLD_Y_UP, .half_colours = true, .tiled = true, .background_depth = 1e30, .attributes = of_arnold},
    {"arnold", "the same without P: the camera is worldToNDC's", NULL, "N:XYZ", "Z", "albedo:RGB", ":RGBA", .world = WORLD_Y_UP,
     .background_depth = 1e30, .attributes = of_arnold},
    {"renderman", "rmanwiki: Arbitrary Output Variables", "__Pworld:rgb", "__Nworld:rgb", "z", "albedo:rgb", "Ci:rgba",
     .world = WORLD_Y_UP, .background_depth = 1e10, .attributes = of_renderman},
    {"renderman", "rmanwiki: built-in P and Nn are in camera space", "P:rgb", "Nn:rgb", "z", "albedo:rgb", "Ci:rgba",
     .world = WORLD_Y_UP, .position_space = IN_CAMERA_FORWARD, .normal_space = IN_CAMERA_FORWARD, .background_depth = INFINITY,
     .attributes = of_renderman},
    {"vray", "header of Psyop's cornellBox_CryptoWildcard.0001.exr: cropped, half normals, cameraTransform", NULL, "normals:XYZ",
     "Z", "VRayDiffuseFilter:RGB", ":RGBA", .half_normals = true, .half_colours = true, .cropped = true, .background_depth = 1e30,
     .attributes = of_vray},
    {"vray", "MrKepzie/Natron#1603: multi-part, plain RGBA in each part", "world_position:RGB", "normals:RGB", "VRayZDepth:R",
     "diffuse:RGB", "rgba:RGBA", .layout = PART_PER_LAYER, .background_depth = 1e30, .attributes = of_vray},
    {"vray", "V-Ray scenes with passes as files; FFmpeg's FATE sample rgba_scanline_float_half_b44_13x9.exr: VRaySamplerInfo",
     "VRaySamplerInfo:RGB", "normals:RGB", "VRayZDepth:R", "VRayDiffuseFilter:RGB", "rgba:RGBA", .unorm_normals = true,
     .layout = FILE_PER_LAYER, .background_depth = 1e30},
    {"vray", "a public layer reader's source: VRaySamplerInfo_World.red", "VRaySamplerInfo_World:rgb", "VRayNormals:rgb",
     "VRayZDepth:R", "VRayDiffuseFilter:rgb", ":RGBA", .background_depth = 1e30},
    {"redshift", "help.maxon.net EXR Metadata, Integrated AOVs", "P:XYZ", "N:XYZ", "Z", "DiffuseFilter:RGB", ":RGBA",
     .world = WORLD_Y_UP, .half_colours = true, .background_depth = 0, .attributes = of_redshift},
    {"redshift", "the same without P: field of view in radians, transform", NULL, "N:XYZ", "Z", "DiffuseFilter:RGB", ":RGBA",
     .world = WORLD_Y_UP, .background_depth = 0, .attributes = of_redshift},
    {"karma", "sidefx.com: Mantra's P is in camera space; ynput/ayon-houdini#76", "P:rgb", "N:rgb", "Pz", "basecolor:RGB",
     "C:RGBA", .world = WORLD_Y_UP, .position_space = IN_CAMERA_BACK, .normal_space = IN_CAMERA_BACK,
     .background_depth = INFINITY, .attributes = of_mantra},
    {"karma", "husk's header: husk:render_stats", "P:XYZ", "N:XYZ", "depth:Z", "albedo:RGB", "C:RGBA", .world = WORLD_Y_UP,
     .half_colours = true, .background_depth = 0, .attributes = of_karma},
    {"octane", "Octane's own pass names; Z-depth is 'the camera ray hit distance'", "Position:RGB", "Shading normal:RGB",
     "Z-depth:R", "Diffuse filter:RGB", "Beauty:RGBA", .world = WORLD_Y_UP, .radial = true, .unorm_normals = true,
     .background_depth = 0},
    {"unreal", "Movie Render Queue: layer names and texts in the header", NULL, "FinalImageMovieRenderQueue_WorldNormal:RGB",
     "FinalImageMovieRenderQueue_WorldDepth:RGB", "FinalImageBaseColor:RGB", ":RGBA", .world = WORLD_UNREAL,
     .background_depth = 1e10, .attributes = of_unreal},
    {"unreal", "the same with a custom position pass, a part per layer", "FinalImageWorldPosition:RGB",
     "FinalImageWorldNormal:RGB", "FinalImageSceneDepth:R", "FinalImageBaseColor:RGB", "FinalImage:RGBA", .world = WORLD_UNREAL,
     .layout = PART_PER_LAYER, .background_depth = 1e10, .attributes = of_unreal},
    {"3delight", "documentation.3delightcloud.com: camera space down -z, colour-coded normals, Z a distance",
     "builtin.P.camera:rgb", "builtin.N.camera:rgb", "builtin:z", "shader.albedo:rgb", "Ci:rgba", .world = WORLD_Y_UP,
     .position_space = IN_CAMERA_BACK, .normal_space = IN_CAMERA_BACK, .unorm_normals = true, .radial = true,
     .background_depth = INFINITY},
    {"mitsuba", "mitsuba3 integrators/aov.cpp: suffix T, ray length, background 0", "pp:XYZ", "nn:XYZ", "dd.y:T", "albedo:RGB",
     ":RGBA", .world = WORLD_Y_UP, .radial = true, .background_depth = 0},
    {"mitsuba", "mitsuba 0.6 src/integrators/misc: the fields position, shNormal and distance (scalar as luminance)",
     "position:RGB", "shNormal:RGB", "distance:Y", "albedo:RGB", ":RGBA", .world = WORLD_Y_UP, .radial = true,
     .background_depth = 0},
    {"corona", "Innobright Altus's guide to Corona: render elements CGeometry_*, CShading_*", "CGeometry_WorldPosition:RGB",
     "CGeometry_NormalsShading:RGB", "CGeometry_ZDepth:R", "CShading_Albedo:RGB", ":RGBA", .background_depth = 1e30},
    {"prorender", "GPUOpen RadeonProRenderBlenderAddon: its AOVs' names", "World Coordinate:XYZ", "Shading Normal:XYZ", "Depth:Z",
     "Diffuse Albedo:RGB", ":RGBA", .background_depth = INFINITY},
    {"luxcore", "LuxCore's output names, a file each", "POSITION:RGB", "SHADING_NORMAL:RGB", "DEPTH:R", "ALBEDO:RGB",
     "RGBA_IMAGEPIPELINE:RGBA", .layout = FILE_PER_LAYER, .radial = true, .background_depth = INFINITY, .attributes = of_luxcore},
    {"moonray", "docs.openmoonray.org RenderOutput: state variable WP; half by default", "WP:XYZ", "N:XYZ", "Z", "albedo:RGB",
     ":RGBA", .world = WORLD_Y_UP, .half_normals = true, .half_colours = true, .background_depth = INFINITY},
    {"plain", "stored with spaces, as a compositor's names: World Position", "World Position:RGB", "World Normal:RGB", "Z",
     "Base Color:RGB", ":RGBA", .world = WORLD_Y_UP, .background_depth = INFINITY},
    {"plain", "no renderer in particular", "P:XYZ", "N:XYZ", "Z", "albedo:RGB", ":RGBA", .world = WORLD_Y_UP,
     .background_depth = INFINITY, .background_position = INFINITY},
};
const int renderer_fact_count = (int)(sizeof renderer_facts / sizeof *renderer_facts);
