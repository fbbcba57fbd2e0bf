// One frame's surfaces in camera space, ready for upload: what the passes read.
//
// All arrays are width * height over the frame's data window, row-major, top row first, owned by the gbuffer (gbuffer_free).
// A pixel holds a surface if and only if its depth is > 0: that, never the normal, is the test for validity.
// Nothing in them is NaN or infinite, whatever the file holds: colours are finite (NaN and -inf become 0, +inf and huge values
// 1e30 at most), depth and normal obey the contracts below.
#ifndef SSDO_GBUFFER_GBUFFER_H
#define SSDO_GBUFFER_GBUFFER_H

#include "base/error.h"
#include "base/log.h"
#include "gbuffer/camera.h"
#include "gbuffer/encoding.h"
#include "gbuffer/resolve.h"
#include "gbuffer/verdict.h"

enum gbuffer_need {
    NEED_ALBEDO = 1 << 0,
    NEED_BEAUTY = 1 << 1,
    NEED_MATERIAL = 1 << 2, // roughness, metallic
    NEED_EMISSION = 1 << 3,
    NEED_DIFFUSE_LIGHT = 1 << 4, // the renderer's own diffuse direct (and whether indirect exists)
    NEED_COVERAGE = 1 << 5,
    NEED_BACKGROUND = 1 << 6, // the beauty, if any pixel is not wholly covered
};

typedef struct gbuffer_options {
    unsigned need;                // gbuffer_need bits; depth and normal are always made
    const char *camera_file;      // --camera
    double fov, ortho;            // --fov, --ortho; 0 = not given
    pass_space normal_space;      // --normal-space; unknown: to be found
    const char *normal_encoding;  // --normal-encoding; NULL: to be found
    double depth_near, depth_far; // --depth-range; far 0: the header's, if it has them
    int threads;
} gbuffer_options;

typedef struct gbuffer {
    int width, height;
    box2 data_window, display_window;
    double pixel_aspect;
    camera camera;
    float *depth;          // planar depth z in camera space, > 0; exactly 0 where there is no surface
    float *normal;         // 4 a pixel: unit camera-space normal, w = 0; all 0 where there is no surface, except as said below
    float *albedo;         // 4 a pixel: r g b as stored (Blender: coverage-premultiplied), w = 0; NULL if absent or not needed
    float *beauty;         // 4 a pixel: r g b, A (1 if absent); NULL
    float *material;       // 2 a pixel: roughness, metallic; NULL
    float *emission;       // 4 a pixel; NULL
    float *diffuse_direct; // 4 a pixel; NULL
    float *coverage;       // k of src/gbuffer/README.md, Coverage, 0..1: 1 inside surfaces; NULL unless needed
    bool has_diffuse_indirect, has_alpha;
    bool normals_from_depth, depth_from_position;
    depth_kind depth_kind; // as measured
    bool position_is_camera_space;
    mat3 normal_from_camera; // to the space of the file's normals; without any to the world, or if that is unknown to camera axes
                             // with y up and z backwards
    size_t valid;            // pixels with a surface
    size_t off_ray;          // pixels whose P lay off their own ray and were moved onto it
    double extent;           // robust size of the visible surfaces, scene units: gbuffer_extent in radius.h
    verdict position_verdict, normal_verdict, depth_verdict;
    char evidence[12][160]; // what was measured, one line each, for -v and the report
    int evidence_count;
} gbuffer;

// Normals that all point into their surfaces are turned round. Otherwise they keep the orientation they are stored with, unless
// they point away from the eye by more than 6 degrees past the silhouette and away from the surface the depths form, or by less
// but against that surface: the back of a double-sided surface, turned towards the eye. So interpolated and bumped normals may
// face away slightly (dot(n, ray) <= 0.1) or, agreeing with the surface, more.
//
// Coverage is 1 away from the background. Within one pixel (3 x 3) of it, it is alpha where alpha varies over the picture, else
// the length of the normal where the renderer averages normals (or, if that is more, the albedo over that of a whole pixel of
// equal chroma within two pixels), else whether there is a surface. A pixel with coverage > 0 and depth 0 (the renderer's one
// sample of position missed the surface that the averaged layers show) keeps depth 0, and its normal is the averaged one,
// renormalised: a later pass fills its layers from the nearest valid neighbour with a similar normal.
//
// Depth is P's camera-space z. Where P was sampled more than 0.02 pixels off its pixel's centre it is instead where the centre's
// ray meets the plane (P, N), unless that plane is seen at a grazing angle (cosine below 0.01; below 0.1 where the depths
// form another surface) or the result leaves the range of the 3 x 3 neighbours' depths (perspective: their inverses) by more than
// half of it. A P further off than 3 pixels (and 10 times
// the median) is not believed: the depth channel's value counts if it is known what that is, else P's own z if a neighbour's lies
// within 2 %, else there is no surface. Where P is coarser than the depth channel by a factor of 16 (half floats, a world far
// from its origin), z comes from that.
//
// Builds the frame from loaded channels. Validity from position and depth (finite, depth > 0, below the background value, not
// P = 0 with a background depth), never from |N|. Works in double and subtracts the camera before anything becomes float.
// Camera order: flag > fit from P cross-checked with the header > header > one plane with planar depth > ERR_INPUT naming --fov,
// --ortho, --camera. A lens given by flag takes its pose from P.
// Positions in camera space (seen from the fit, unless the convention promises world space) leave has_world false.
// `log` may be NULL.
// Without P: positions from depth (planar or radial); without N: normals from depth (said in a warning).
// A frame without any surface is not an error: valid = 0, and the camera is whatever is known.
bool gbuffer_build(const exrio_file *file, const resolution *r, const gbuffer_options *options, gbuffer *out, log_t *log,
                   error *e);
void gbuffer_free(gbuffer *g);

// The first role of which it is doubtful what it means; NULL when there is none.
const char *gbuffer_doubt(const gbuffer *g);

// Camera-space position of pixel (x, y), from its depth; z = 0 where there is no surface.
vec3 gbuffer_position(const gbuffer *g, int x, int y);

// The automatic occlusion radius of one frame, scene units: a fixed share of the visible surfaces' extent (source and share in
// radius.c). 0 without surfaces.
double gbuffer_auto_radius(const gbuffer *g);

#endif
