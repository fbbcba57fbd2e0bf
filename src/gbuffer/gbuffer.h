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
#include <stdint.h>

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
    unsigned need;           // gbuffer_need bits; depth and normal are always made
    const char *camera_file; // --camera
    double fov, ortho;       // --fov, --ortho; 0 = not given
    pass_space normal_space; // --normal-space; unknown: to be found
    bool encoding_told;      // by --normal-encoding, else it is to be found
    normal_encoding normal_encoding;
    double depth_near, depth_far; // --depth-range; far 0: the header's, if it has them
    int threads;
} gbuffer_options;

// A pixel of which a neighbour's surface covers a part.
typedef struct mixed_pixel {
    uint32_t pixel; // x | y << 16
    int8_t x, y;    // to the neighbour, -1 to 1
    float share;    // of the pixel that is the neighbour's surface, above 0 to 1
} mixed_pixel;

typedef struct gbuffer {
    int width, height;
    box2 data_window, display_window;
    double pixel_aspect;
    camera camera;
    float *depth;    // planar depth z in camera space, > 0; exactly 0 where there is no surface
    float *normal;   // 4 a pixel: unit camera-space normal, w = 0; all 0 where there is no surface, but see Coverage and Mixed
                     // pixels below
    float *albedo;   // 4 a pixel: r g b as stored (Blender: coverage-premultiplied), w = 0; NULL if absent or not needed
    float *beauty;   // 4 a pixel: r g b, A (1 if absent); NULL
    float *material; // 2 a pixel: roughness, metallic; NULL
    float *emission; // 4 a pixel; NULL
    float *diffuse_direct; // 4 a pixel; NULL
    float *coverage;       // k of src/gbuffer/README.md, Coverage, 0..1: 1 inside surfaces; NULL unless needed
    mixed_pixel *mixed;    // row by row, where the renderer averages normals; see Mixed pixels below
    size_t mixed_count;
    bool has_diffuse_indirect, has_alpha;
    bool normals_from_depth, depth_from_position;
    depth_kind depth_kind; // as measured
    bool position_is_camera_space;
    mat3 normal_from_camera; // to the space of the file's normals. Without normals: to the world; without a known world: to
                             // camera axes with y up and z backwards
    size_t valid;            // pixels with a surface
    size_t off_ray;          // pixels whose P lay off their own ray and were moved onto it
    double extent;           // robust size of the visible surfaces, scene units: gbuffer_extent in radius.h
    verdict position_verdict, normal_verdict, depth_verdict;
    char evidence[12][160]; // what was measured, one line each, for -v and the report
    int evidence_count;
} gbuffer;

// Normals. If all normals of the file point into their surfaces, all are reversed. Beyond that, a normal is reversed only where
// it shows the back of a two-sided surface. There it points away from the eye, and the normal that the depths give tells the
// rest:
//   dot(n, ray) > 0.1 (more than 6 degrees past the silhouette)   and the two are more than 90 degrees apart; or
//   0 < dot(n, ray) <= 0.1                                        and they are more than 120 degrees apart.
// All other normals are kept. So an interpolated or bumped normal may face away a little, or more where it agrees with the
// depths.
//
// Mixed pixels. A renderer may store the mean of all normals in a pixel beside the depth of one sample (Blender does). Such a
// mean is shorter than 1. A pixel whose mean is shorter than .98 takes the normal of a neighbour (of the 3 x 3) on whose tangent
// plane it lies, if that normal is nearer to unit length. If its own normal and one neighbour's, by shares that add up to 1, then
// come nearer to the mean than its own alone, it is listed in `mixed`. The fourth number of its normal is the mean's length - 1
// (below 0). Near the background, alpha must tell how much of the pixel is covered.
//
// Coverage is 1, except within one pixel (3 x 3) of the background. There it is the first of these that the file allows:
//   alpha, if alpha varies over the picture;
//   the length of the normal, if the renderer averages normals. If there is a whole pixel of equal chroma within two pixels, the
//   ratio of the albedos is taken where it is larger;
//   1 where there is a surface, else 0.
// A pixel can have coverage > 0 and depth 0: the averaged layers show a surface that the renderer's one sample of position
// missed. It keeps depth 0, and its normal is the averaged one at unit length. A later pass fills its layers from the nearest
// valid neighbour with a similar normal.
//
// Depth is P's camera-space z, with three exceptions:
//   - P lies more than 0.02 pixels off its pixel's centre. Then depth is where the centre's ray meets the plane (P, N). P's own z
//   is
//     kept where that plane is seen at a grazing angle (cosine below 0.01; below 0.1 where the depths form another surface), or
//     where the result leaves the range of the 3 x 3 depths (perspective: of their inverses) by more than half of that range (at
//     the frame's border: by more than that range).
//   - P lies more than 3 pixels off, and more than 10 times the camera's median error. Then P is not believed. Depth is the depth
//     channel's value if its meaning is known; else P's z if a neighbour's depth lies within 2 % of it; else there is no surface.
//   - P is coarser than the depth channel by a factor of 16 (half floats, a world far from its origin). Then depth is that
//   channel's.
//
// Builds the frame from loaded channels. Validity comes from position and depth (finite, depth > 0, below the background value,
// not P = 0 with a background depth), never from |N|. Works in double and subtracts the camera before anything becomes float.
// Camera order: flag > fit from P cross-checked with the header > header > one plane with planar depth > ERR_INPUT naming --fov,
// --ortho, --camera. A lens given by flag takes its pose from P.
// Positions in camera space (seen from the fit, unless the convention promises world space) leave has_world false.
// `log` may be NULL.
// Without P: positions from depth (planar or radial); without N: normals from depth (said in a warning).
// A frame without any surface is not an error: valid = 0, and the camera is whatever is known.
bool gbuffer_build(const exrio_file *file, const resolution *r, const gbuffer_options *options, gbuffer *out, log_t *log,
                   error *e);
void gbuffer_free(gbuffer *g);

// The first role whose meaning is doubtful; NULL when there is none.
const char *gbuffer_doubt(const gbuffer *g);

// Camera-space position of pixel (x, y), from its depth; z = 0 where there is no surface.
vec3 gbuffer_position(const gbuffer *g, int x, int y);

// The automatic occlusion radius of one frame, scene units: a fixed share of the visible surfaces' extent (source and share in
// radius.c). 0 without surfaces.
double gbuffer_auto_radius(const gbuffer *g);

#endif
