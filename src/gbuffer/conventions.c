#include "gbuffer/conventions.h"

#include <string.h>

// Blender writes 1e10 where nothing is hit and 1e11 outside a border render; half and other renderers' infinities lie above too.
enum { FAR_AWAY = 1000000000 };

const convention conventions[] = {
    {
        // Cycles and Eevee, multilayer file and File Output node (facts/ecosystem.md 1.1, 1.3).
        .name = "blender",
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
        // Common names of no renderer in particular. The last row: other rows fall back on it.
        .name = "plain",
        .patterns =
            {
                [ROLE_POSITION] = {"P", "position", "Pworld", "world_position", "worldposition"},
                [ROLE_NORMAL] = {"N", "normal", "normals", "Nworld", "world_normal", "worldnormal"},
                [ROLE_DEPTH] = {"/Z", "Z", "depth", "zdepth"},
                [ROLE_ALBEDO] = {"albedo", "diffuse_albedo", "diffuse_color", "diffcol", "base_color", "basecolor"},
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
