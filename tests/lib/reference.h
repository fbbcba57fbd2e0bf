// Reference A (tests/README.md): what each estimator would give with endless samples on the same layers, in double precision,
// written from the definitions and independent of any shader. Slow; for a few thousand pixels (reference_pixels).
//
// The layers are read as the definition of the surfaces: the surface recorded at pixel q is its tangent plane (P_q, N_q), seen
// through the pixel's own square, its depth limited to what that square can hold, judged from the neighbours. So nothing depends
// on where inside a pixel a sample falls, and an empty plane is a plane to rounding at every tilt. Background pixels and
// everything outside the frame hold no surface: open.
//
// All points and directions are in camera space (gbuffer/camera.h); V is the unit vector from a point to the eye. Results are
// open shares unless said otherwise. Functions taking a pixel expect one with a surface. Read-only on the layer, so safe on
// threads.
#ifndef SSDO_TESTS_REFERENCE_H
#define SSDO_TESTS_REFERENCE_H

#include "base/error.h"
#include "gbuffer/gbuffer.h"
#include "truth.h"

// --- The layer ---

typedef struct surfel {
    vec3 position, normal;
    double slack; // how far the depth may leave position.z inside the pixel; negative: no surface
} surfel;

typedef struct layer {
    int width, height;
    camera camera;
    surfel *surfels;
    const float *albedo; // the gbuffer's, borrowed; may be NULL
} layer;

// Reads depth, normal and camera of a gbuffer.
bool layer_build(const gbuffer *g, layer *out, error *e);
void layer_free(layer *l);
// The surfel of a pixel, NULL outside the frame and where there is no surface.
const surfel *layer_at(const layer *l, int x, int y);
bool layer_project(const layer *l, vec3 p, double *x, double *y); // false at or behind the eye
vec3 layer_to_eye(const layer *l, vec3 p);                        // V
// The point where the surface of one pixel meets the view ray through (x, y), which lies in that pixel or on its border.
vec3 layer_surface(const layer *l, const surfel *s, double x, double y);
// The surfel of the pixel that holds (x, y), and *point on its surface; NULL as for layer_at.
const surfel *layer_sample(const layer *l, double x, double y, vec3 *point);

// --- Pixels to compare at ---

typedef struct pixel {
    int x, y;
} pixel;
// Up to `max` (4096 is the standard) valid pixels, spread evenly: one a cell of a grid over the frame, the cell's choice by a
// fixed hash. The same for the same validity mask. Returns their number.
int reference_pixels(const layer *l, int max, pixel *out);

// --- SSDO's point test ---

typedef struct reference_ssdo_options {
    double radius;
    double thickness; // blocked only if 0 < depth behind the surface <= thickness, along the view axis; INFINITY
    int elevations, azimuths, distances; // quadrature; 0 = 64, 64, 32
    truth_sky sky;                       // world direction (camera direction if the camera has no pose); NULL = white
    void *sky_data;
    // Bounce, computed if both the layer's albedo and this exist: 4 a pixel, the `radiance` layer of the senders.
    const float *sender_radiance;
    int patches;       // N of A_s = pi R^2 / N; 0 = 16
    double fade_start; // share of R where the fade of senders begins; it reaches 0 at R. 1 = no fade inside R
    bool fade_smooth;  // smoothstep instead of a line
} reference_ssdo_options;

typedef struct reference_ssdo_result {
    double occlusion;  // cosine-weighted open share
    double visibility; // luminance- and cosine-weighted open share; 1 under a black sky
    vec3 radiance;     // (1/pi) integral of L V cos
    // min(1, B / F) * sum over N patches of albedo_s radiance_s f: f = A_s cos_s cos_r / (pi d^2 + A_s), F the sum of f before
    // the fade, B = 1 - occlusion. Senders facing away are dropped.
    vec3 indirect;
} reference_ssdo_result;

// V(w) is the mean over distances lambda, uniform in (0, R], of the point test at P + lambda w.
reference_ssdo_result reference_ssdo(const layer *l, pixel p, const reference_ssdo_options *o);

// --- Alchemy ---

typedef enum tap_measure { TAPS_UNIFORM_IN_RADIUS, TAPS_UNIFORM_IN_AREA } tap_measure;

typedef struct reference_alchemy_options {
    double radius;
    double bias;         // a length
    tap_measure measure; // where an endless number of taps would fall: the chapter's spiral is uniform in radius and angle
    int radii, angles;   // quadrature; 0 = 128, 128
    bool points;         // the surface of a pixel is the point in its middle, as the shader has it
} reference_alchemy_options;

// S = mean over the taps of 2 pi c max(0, N.w - bias) H(R - |w|) / max(c^2, w.w), c = 0.1 R, w from P to the recorded surface,
// the taps in the ellipse of R fx/z by R fy/z pixels (orthographic: R fx by R fy). The blocked measure itself: no scale, no
// contrast.
double reference_alchemy(const layer *l, pixel p, const reference_alchemy_options *o);

// --- The normal-oriented hemisphere ---

typedef struct reference_hemisphere_options {
    double radius;
    int elevations, azimuths, distances; // quadrature; 0 = 48, 48, 48
} reference_hemisphere_options;

// Open share of points P + R u (0.1 + 0.9 t^2) d: u, t uniform in 0..1, d the direction of a point uniform in the half cube
// [-1, 1]^2 x [0, 1] over the normal, at a random turn. Blocked: the recorded surface is nearer to the camera than the point, and
// its depth within R of the receiver's.
double reference_hemisphere(const layer *l, pixel p, const reference_hemisphere_options *o);

// --- HBAO ---

typedef struct reference_hbao_options {
    double radius;
    double bias;           // radians
    int directions, steps; // quadrature; 0 = 128, 512
} reference_hbao_options;

// 1 - the mean, over directions about V, of sum (1 - (d/R)^2) (sin h - sin h_prev): h the running maximum of the elevation over
// the plane across V, from the tangent + bias on, of the surface under the line from P's pixel to the projection of R.
double reference_hbao(const layer *l, pixel p, const reference_hbao_options *o);

// --- Slices: horizon (GTAO) and bitmask ---

typedef struct reference_slice_options {
    double radius;    // cutoff: surface farther than this from P does not block; INFINITY is allowed
    double thickness; // bitmask only: length along the view ray, away from the eye; INFINITY is allowed
    int slices;       // uniform in angle around V; 0 = 128
    // The surface of a pixel is the point in its middle, brought into the slice at its height over the tangent plane of P, and
    // the line is looked at in steps of one pixel: what the shaders see with endless samples. Otherwise exact pieces of surface.
    bool points;
} reference_slice_options;

// Cumulative cosine weight along a slice: integral of |sin t| cos(t - n) from 0 to t (shaders/README.md, Slices and sectors).
double reference_slice_measure(double t, double n);

// Highest horizon on either side of each slice, every pixel on its screen line; all beyond the horizon is blocked.
double reference_horizon(const layer *l, pixel p, const reference_slice_options *o);
// Each piece of surface blocks the arc from its front to its back; the union of the arcs is taken exactly.
double reference_bitmask(const layer *l, pixel p, const reference_slice_options *o);

#endif
