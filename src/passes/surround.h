// The surround: what further G-buffers show of the world around their eyes, in all directions (shaders/README.md, Outside).
#ifndef SSDO_PASSES_SURROUND_H
#define SSDO_PASSES_SURROUND_H

#include "gbuffer/world_view.h"

#include "../../shaders/include/constants.glsl"

// One map for each place that views are seen from. Directions are those of the axes of the environment's map
// (light/environment.h), from the map's own eye; texels are octahedral (Engelhardt and Dachsbacher 2008: octahedral maps).
typedef struct surround_map {
    vec3 eye;      // world space
    double extent; // mean distance of what is seen
    double known;  // the share of all texels that tell something
    // SURROUND_SIDE squared texels of two distances. The first is of a shell about the eye: of the nearest surface in its
    // direction; negative, of the rim of an opening through which the outdoors are seen (openings.h); 0 where nothing is known.
    // The second is of what is seen through an opening, 0 for the sky. Points are splatted as large as their pixels appear from
    // the eye; gaps of a few texels between them are filled. Borrowed, comes zeroed.
    float (*shell)[2];
    // SURROUND_COARSE squared texels: r g b, the mean albedo of what is seen; a: 1, or 0 where it is not known. Borrowed, comes
    // zeroed.
    float (*albedo)[4];
} surround_map;

// Which maps views make: those with the same eye share one. Fills the map of each view, and of each map the eye and the extent;
// returns how many maps there are. The caller then gives each map its arrays.
int surround_maps(const world_view *views, int count, int map_of[MAX_FURTHER], surround_map maps[MAX_FURTHER]);

// Fills them. Deterministic, whatever the threads.
bool surround_make(const world_view *views, int count, mat3 map_from_world, int threads, const int map_of[MAX_FURTHER],
                   surround_map maps[MAX_FURTHER], int map_count, error *e);

// The unit direction of a place on a map of `side` texels a side.
vec3 surround_direction(double x, double y, int side);
// The texel, by rows, that a direction of any length lies in.
size_t surround_texel(vec3 direction, int side);

#endif
