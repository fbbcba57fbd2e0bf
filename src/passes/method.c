#include "passes/method.h"

#include <stdio.h>
#include <string.h>

const method methods[] = {
    {
        .name = "arc",
        .summary = "arcs blocked by runs of connected surface, of a thickness taken from their width, in slices around the view "
                   "vector; large planes stand in for what the camera does not see",
        .weighting = "cosine",
        .reach = "surfaces within the radius; for light and bounce at any distance",
        .blind = "hidden and off-screen surfaces that are not on a large visible plane; the back of what it sees is a guess",
        .samples = 64,
        .blur = 4,
        .thickness = 0.15,
        .fills_radiance = true,
        .fills_bent = true,
        .adaptive = true,
        .bounce = "arc",
        .run = pass_arc,
    },
    {
        .name = "ssdo",
        .summary = "screen-space directional occlusion (Ritschel, Grosch, Seidel 2009): a point on each hemisphere direction",
        .weighting = "cosine",
        .reach = "points up to the radius",
        .blind = "thin and near blockers between the points; whatever the camera does not see",
        .samples = 64,
        .blur = 4,
        .thickness = 2.0,
        .fills_radiance = true,
        .bounce = "ssdo",
        .run = pass_ssdo,
    },
    {
        .name = "alchemy",
        .summary = "Alchemy obscurance (McGuire et al. 2011): taps on a disc, no visibility test",
        .weighting = "obscurance: cosine over distance, near blockers count more",
        .reach = "surfaces within the radius",
        .blind = "direction: light is SH irradiance times occlusion; whatever the camera does not see",
        .samples = 32,
        .blur = 4,
        .thickness = 0.0,
        .fills_radiance = false,
        .bounce = NULL,
        .run = pass_alchemy,
    },
    {
        .name = "hemisphere",
        .summary = "normal-oriented hemisphere: points in the half space over the normal, with a range check",
        .weighting = "the common tutorial's kernel: nearly solid angle, near points count more",
        .reach = "points up to the radius, most of them within half of it",
        .blind = "direction: light is SH irradiance times occlusion; whatever the camera does not see",
        .samples = 64,
        .blur = 4,
        .thickness = 0.0,
        .fills_radiance = false,
        .bounce = NULL,
        .run = pass_hemisphere,
    },
    {
        .name = "hbao",
        .summary = "horizon-based occlusion (Bavoil et al. 2008): one horizon a direction, weight 1 - r^2",
        .weighting = "solid angle, blockers fade with distance",
        .reach = "surfaces within the radius",
        .blind = "all beneath a horizon is blocked; light is SH irradiance times occlusion; whatever the camera does not see",
        .samples = 256,
        .blur = 2,
        .thickness = 0.0,
        .fills_radiance = false,
        .bounce = NULL,
        .run = pass_hbao,
    },
    {
        .name = "s3ho",
        .summary = "spherical harmonics of the cosine-weighted visibility (Herholz et al. 2011), relit by a dot product",
        .weighting = "cosine",
        .reach = "points up to the radius",
        .blind = "sharp shadows: nine coefficients hold soft ones only; the rest as ssdo",
        .samples = 32,
        .blur = 2,
        .thickness = 2.0,
        .fills_radiance = true,
        .fills_sh = true,
        .bounce = NULL,
        .run = pass_s3ho,
    },
    {
        .name = "gtao",
        .summary = "horizons in slices around the view vector (Jimenez et al. 2016)",
        .weighting = "cosine",
        .reach = "surfaces within the radius",
        .blind = "all behind a horizon: thin surfaces darken too much; light is SH irradiance times occlusion",
        .samples = 256,
        .blur = 2,
        .thickness = 0.0,
        .fills_radiance = false,
        .fills_bent = true,
        .adaptive = true,
        .bounce = NULL,
        .run = pass_gtao,
    },
    {
        .name = "bitmask",
        .summary = "visibility bitmask of constant thickness (Therrien et al. 2023), sectors of equal cosine weight",
        .weighting = "cosine",
        .reach = "surfaces within the radius",
        .blind = "gaps between samples; light is SH irradiance times occlusion",
        .samples = 256,
        .blur = 2,
        .thickness = 0.3,
        .fills_radiance = false,
        .fills_bent = true,
        .adaptive = true,
        .bounce = NULL,
        .run = pass_bitmask,
    },
    {0},
};

const method method_raytrace = {
    .name = "raytrace",
    .summary = "the picture's points against the scene's own mesh (--mesh): the truth, up to noise",
    .weighting = "cosine",
    .reach = "the mesh within the radius; for light and bounce at any distance",
    .blind = "what is not in the mesh: textures, smooth normals, emission, transparency",
    .samples = 64,
    .blur = 0,
    .thickness = 0.0,
    .fills_radiance = true,
    .needs_mesh = true,
    .bounce = "raytrace",
    .run = pass_raytrace,
};

const method *method_at(int i)
{
    int pictures = (int)(sizeof methods / sizeof *methods) - 1; // without the row that ends them
    return i < pictures ? &methods[i] : i == pictures ? &method_raytrace : NULL;
}

const method *method_find(const char *name)
{
    const method *m;
    for (int i = 0; (m = method_at(i)); i++)
        if (strcmp(m->name, name) == 0) return m;
    return NULL;
}

void method_names(char *text, size_t size, const char *between)
{
    const method *m;
    text[0] = '\0';
    for (int i = 0; (m = method_at(i)); i++) {
        size_t used = strlen(text);
        snprintf(text + used, size - used, "%s%s", i ? between : "", m->name);
    }
}
