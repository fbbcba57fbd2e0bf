#include "gbuffer/conventions.h"

#include <string.h>

#include "gbuffer/layers.h"

// Blender writes 1e10 where nothing is hit and 1e11 outside a border render; half and other renderers' infinities lie above too.
enum { FAR_AWAY = 1000000000 };

const convention conventions[] = {
    {
        // Cycles and Eevee, multilayer file and File Output node.
        .name = "blender",
        .confirmed = true,
        .marks = {"BlenderMultiChannel"},
        .patterns =
            {
                [ROLE_POSITION] = {"Position"},
                [ROLE_NORMAL] = {"Normal"},
                [ROLE_DEPTH] = {"Depth", "/Z"},
                [ROLE_ALBEDO] = {"DiffCol", "Diffuse Color"},
                [ROLE_BEAUTY] = {"Combined", "Image", "/"},
                [ROLE_ALPHA] = {"Combined/A", "Image/A", "/A"},
                [ROLE_ROUGHNESS] = {"Roughness"},
                [ROLE_METALLIC] = {"Metallic"},
                [ROLE_EMISSION] = {"Emit", "Emission"},
                [ROLE_DIFFUSE_DIRECT] = {"DiffDir", "Diffuse Direct"},
                [ROLE_DIFFUSE_INDIRECT] = {"DiffInd", "Diffuse Indirect"},
            },
        .albedo = ALBEDO_DIFFUSE,
        .position_space = SPACE_WORLD,
        .normal_space = SPACE_WORLD,
        .normals_averaged = true,
        .depth = DEPTH_PLANAR,
        .background_depth = FAR_AWAY,
        .up_is_z = true,
    },
    {
        // Vector AOVs by their own names, often tiled. worldToNDC is clip space (camera_header.c tries that reading).
        .name = "arnold",
        .marks = {"arnold/*"},
        .patterns =
            {
                [ROLE_POSITION] = {"P"},
                [ROLE_NORMAL] = {"N"},
                [ROLE_DEPTH] = {"/Z", "Z"},
                [ROLE_ALBEDO] = {"albedo", "diffuse_albedo", "denoise_albedo"},
                [ROLE_BEAUTY] = {"/", "RGBA"},
            },
        .diffuse_albedo = {"diffuse_albedo"},
        .albedo = ALBEDO_BASE,
        .position_space = SPACE_WORLD,
        .normal_space = SPACE_WORLD,
        .depth = DEPTH_PLANAR,
        .background_depth = FAR_AWAY,
        .camera = {.fov = "CameraFov", .pose = "worldToCamera", .world_to_camera = true, .looks_along_z = true},
    },
    {
        // P and Nn are in camera ("current") space, the double-underscored user AOVs in world space, lower case components.
        .name = "renderman",
        .marks = {"rman*", "Software=PRMan", "Software=RenderMan"},
        .patterns =
            {
                [ROLE_POSITION] = {"__Pworld", "Pworld", "P"},
                [ROLE_NORMAL] = {"__Nworld", "Nworld", "Nn"},
                [ROLE_DEPTH] = {"/z", "z", "__depth/R"},
                [ROLE_ALBEDO] = {"albedo"},
                [ROLE_BEAUTY] = {"Ci", "/"},
                [ROLE_ALPHA] = {"Ci/A", "/A", "a"},
            },
        .albedo = ALBEDO_BASE,
        .depth = DEPTH_PLANAR,
        .background_depth = FAR_AWAY,
        .camera = {.pose = "worldToCamera", .world_to_camera = true, .looks_along_z = true},
    },
    {
        // No position of its own; depth is the distance to the camera's plane; the data window is cropped to what was rendered.
        .name = "vray",
        .marks = {"vrayInfo/*"},
        .patterns =
            {
                [ROLE_POSITION] = {"VRayWorldPosition", "VRaySamplerInfo", "VRaySamplerInfo_World", "world_position"},
                [ROLE_NORMAL] = {"normals", "VRayNormals", "bump_normals", "bumpnormals", "VRayBumpNormals"},
                [ROLE_DEPTH] = {"/Z", "VRayZDepth", "zDepth"},
                [ROLE_ALBEDO] = {"VRayDiffuseFilter", "diffuse", "diffuseFilter"},
            },
        .diffuse_albedo = {"VRayDiffuseFilter", "diffuse", "diffuseFilter"},
        .albedo = ALBEDO_BASE,
        .depth = DEPTH_PLANAR,
        .background_depth = FAR_AWAY,
        .camera = {.fov = "cameraFov", .pose = "cameraTransform"},
    },
    {
        .name = "redshift",
        .marks = {"rs/*", "RSCamera*"},
        .patterns =
            {
                [ROLE_POSITION] = {"P", "WorldPosition"},
                [ROLE_NORMAL] = {"N", "Normals", "BumpNormals"},
                [ROLE_DEPTH] = {"/Z", "Z", "Depth"},
                [ROLE_ALBEDO] = {"DiffuseFilter"},
            },
        .diffuse_albedo = {"DiffuseFilter"},
        .albedo = ALBEDO_BASE,
        .depth = DEPTH_PLANAR,
        .background_depth = FAR_AWAY,
        .camera = {.fov = "rs/camera/fov", .radians = true, .pose = "rs/camera/transform"},
    },
    {
        // Mantra's P is in camera space. Its worldToNDC has w = -z and a mirrored x.
        .name = "karma",
        .marks = {"husk:*", "karma:*", "Software=Houdini"},
        .patterns =
            {
                [ROLE_POSITION] = {"P", "hitP"},
                [ROLE_NORMAL] = {"N", "hitN"},
                [ROLE_DEPTH] = {"Pz", "hitPz", "depth", "/Z"},
                [ROLE_ALBEDO] = {"albedo", "basecolor", "diffuse_color"},
                [ROLE_BEAUTY] = {"/", "C", "Cf"},
            },
        .diffuse_albedo = {"diffuse_color"},
        .albedo = ALBEDO_BASE,
        .depth = DEPTH_PLANAR,
        .background_depth = FAR_AWAY,
        .camera = {.pose = "worldToCamera", .world_to_camera = true, .looks_along_z = true},
    },
    {
        // Info passes; the depth is the length of the camera ray.
        .name = "octane",
        .marks = {"octane*", "Software=Octane"},
        .patterns =
            {
                [ROLE_POSITION] = {"Position", "Pos"},
                [ROLE_NORMAL] = {"Shading normal", "ShadingNormal", "Smooth normal", "Geometric normal", "Normal"},
                [ROLE_DEPTH] = {"Z-depth", "ZDepth", "/Z"},
                [ROLE_ALBEDO] = {"Diffuse filter", "DiffuseFilter"},
                [ROLE_BEAUTY] = {"Beauty", "Main", "/"},
                [ROLE_ALPHA] = {"Beauty/A", "Main/A", "/A"},
            },
        .diffuse_albedo = {"Diffuse filter", "DiffuseFilter"},
        .albedo = ALBEDO_BASE,
        .depth = DEPTH_RADIAL,
        .background_depth = FAR_AWAY,
    },
    {
        // Movie Render Queue: left-handed, z up, centimetres; its header keeps numbers as texts.
        .name = "unreal",
        .marks = {"unreal/*"},
        .patterns =
            {
                [ROLE_POSITION] = {"FinalImageWorldPosition", "FinalImageMovieRenderQueue_WorldPosition", "WorldPosition"},
                [ROLE_NORMAL] = {"FinalImageMovieRenderQueue_WorldNormal", "FinalImageWorldNormal", "WorldNormal"},
                [ROLE_DEPTH] = {"FinalImageMovieRenderQueue_WorldDepth/R", "FinalImageSceneDepth", "FinalImageWorldDepth",
                                "WorldDepth", "SceneDepth"},
                [ROLE_ALBEDO] = {"FinalImageBaseColor", "FinalImageMovieRenderQueue_BaseColor", "BaseColor"},
                [ROLE_BEAUTY] = {"/", "FinalImage"},
                [ROLE_ALPHA] = {"/A", "FinalImage/A"},
                [ROLE_ROUGHNESS] = {"FinalImageRoughness"},
                [ROLE_METALLIC] = {"FinalImageMetallic"},
            },
        .albedo = ALBEDO_BASE,
        .position_space = SPACE_WORLD,
        .normal_space = SPACE_WORLD,
        .depth = DEPTH_PLANAR,
        .background_depth = FAR_AWAY,
        .up_is_z = true,
        .camera = {.fov = "unreal/camera/FinalImage/fov", .angles = "unreal/camera/cur"},
    },
    {
        // Camera space looking down -z; camera-space normals as colours; Z is the distance between camera and object.
        .name = "3delight",
        .marks = {"3delight*", "Software=3Delight"},
        .patterns =
            {
                [ROLE_POSITION] = {"P", "P.world", "P.camera"},
                [ROLE_NORMAL] = {"N", "N.world", "N.camera"},
                [ROLE_DEPTH] = {"Z", "/Z", "builtin/Z"},
                [ROLE_ALBEDO] = {"albedo", "shader.albedo", "relighting_multiplier"},
                [ROLE_BEAUTY] = {"Ci", "/"},
                [ROLE_ALPHA] = {"Ci/A", "/A"},
            },
        .albedo = ALBEDO_BASE,
        .normal_encoding = NORMAL_UNORM,
        .depth = DEPTH_RADIAL,
        .background_depth = FAR_AWAY,
    },
    {
        // The aov integrator: the layers' names are the user's, a depth's component is T and holds the ray's length, 0 behind.
        .name = "mitsuba",
        .marks = {"generatedBy=Mitsuba"},
        .patterns =
            {
                [ROLE_POSITION] = {"position", "pos", "pp", "P"},
                [ROLE_NORMAL] = {"sh_normal", "geo_normal", "normal", "nn", "N"}, // shNormal, geoNormal: Mitsuba 0.6's field
                [ROLE_DEPTH] = {"depth/T", "*/T", "distance"},
                [ROLE_ALBEDO] = {"albedo"},
            },
        .albedo = ALBEDO_BASE,
        .position_space = SPACE_WORLD,
        .normal_space = SPACE_WORLD,
        .depth = DEPTH_RADIAL,
        .background_depth = FAR_AWAY,
    },
    {
        // One file per output.
        .name = "luxcore",
        .marks = {"Software=LuxCore"},
        .patterns =
            {
                [ROLE_POSITION] = {"POSITION"},
                [ROLE_NORMAL] = {"SHADING_NORMAL", "AVG_SHADING_NORMAL", "GEOMETRY_NORMAL"},
                [ROLE_DEPTH] = {"DEPTH"},
                [ROLE_ALBEDO] = {"ALBEDO"},
                [ROLE_BEAUTY] = {"RGBA_IMAGEPIPELINE", "RGB_IMAGEPIPELINE", "/"},
                [ROLE_ALPHA] = {"RGBA_IMAGEPIPELINE/A", "ALPHA", "/A"},
            },
        .albedo = ALBEDO_BASE,
        .position_space = SPACE_WORLD,
        .normal_space = SPACE_WORLD,
        .depth = DEPTH_RADIAL,
        .background_depth = FAR_AWAY,
        .up_is_z = true,
    },
    {
        // State variables as outputs; half floats unless the channel format says otherwise.
        .name = "moonray",
        .marks = {"moonray*"},
        .patterns =
            {
                [ROLE_POSITION] = {"WP", "Wp", "P"},
                [ROLE_NORMAL] = {"N", "Ng"},
                [ROLE_DEPTH] = {"/Z", "Z", "depth"},
                [ROLE_ALBEDO] = {"albedo"},
            },
        .albedo = ALBEDO_BASE,
        .depth = DEPTH_PLANAR,
        .background_depth = FAR_AWAY,
        .camera = {.pose = "worldToCamera", .world_to_camera = true, .looks_along_z = true},
    },
    {
        // Render elements by their classes' names; the artist may clamp and invert the depth.
        .name = "corona",
        .marks = {"corona*", "Software=Corona"},
        .patterns =
            {
                [ROLE_POSITION] = {"CGeometry_WorldPosition"},
                [ROLE_NORMAL] = {"CGeometry_NormalsShading", "CGeometry_NormalsGeometry"},
                [ROLE_DEPTH] = {"CGeometry_ZDepth"},
                [ROLE_ALBEDO] = {"CShading_Albedo", "CShading_SourceColor"},
            },
        .albedo = ALBEDO_BASE,
        .depth = DEPTH_PLANAR,
        .background_depth = FAR_AWAY,
        .up_is_z = true,
    },
    {
        // Radeon ProRender's AOVs by their names in its plug-ins.
        .name = "prorender",
        .patterns =
            {
                [ROLE_POSITION] = {"World Coordinate"},
                [ROLE_NORMAL] = {"Shading Normal", "Geometric Normal", "Camera Normal"},
                [ROLE_DEPTH] = {"Depth"},
                [ROLE_ALBEDO] = {"Diffuse Albedo"},
            },
        .diffuse_albedo = {"Diffuse Albedo"},
        .albedo = ALBEDO_BASE,
        .depth = DEPTH_PLANAR,
        .background_depth = FAR_AWAY,
    },
    {
        // Common names of no renderer in particular. The last row: other rows fall back on it.
        .name = "plain",
        .confirmed = true,
        .patterns =
            {
                [ROLE_POSITION] = {"P", "position", "Pworld", "world_position", "Pcam", "VRaySamplerInfo", "pos"},
                [ROLE_NORMAL] = {"N", "normal", "normals", "Nworld", "world_normal", "Ncam", "shnormal", "nrm"},
                [ROLE_DEPTH] = {"/Z", "Z", "depth", "zdepth"},
                [ROLE_ALBEDO] = {"albedo", "diffuse_albedo", "diffuse_color", "diffcol", "base_color", "alb"},
                [ROLE_BEAUTY] = {"/", "beauty", "rgba", "rgb", "combined", "Ci", "C"},
                [ROLE_ALPHA] = {"/A", "beauty/A", "rgba/A", "combined/A", "Ci/A", "alpha", "/alpha"},
                [ROLE_ROUGHNESS] = {"roughness"},
                [ROLE_METALLIC] = {"metallic", "metalness"},
                [ROLE_EMISSION] = {"emission", "emit", "emissive"},
                [ROLE_DIFFUSE_DIRECT] = {"DiffDir"},
                [ROLE_DIFFUSE_INDIRECT] = {"DiffInd"},
            },
        .diffuse_albedo = {"diffuse_albedo", "diffuse_color", "diffcol"},
        .albedo = ALBEDO_BASE,
        .depth = DEPTH_PLANAR,
        .background_depth = FAR_AWAY,
        .up_is_z = false,
    },
};
const int convention_count = (int)(sizeof conventions / sizeof *conventions);

const convention *convention_named(const char *name)
{
    for (int i = 0; i < convention_count; i++)
        if (name && strcmp(conventions[i].name, name) == 0) return &conventions[i];
    return &conventions[convention_count - 1];
}

bool convention_knows(role r, const char *name)
{
    for (int i = 0; i < convention_count; i++)
        for (int p = 0; p < CONVENTION_PATTERNS && conventions[i].patterns[r][p]; p++) {
            const char *pattern = conventions[i].patterns[r][p];
            if (pattern[0] != '/' && pattern[0] != '*' && layers_name_is(name, pattern)) return true;
        }
    return false;
}
