// What the steps of gbuffer_build share. Internal to the room.
#ifndef SSDO_GBUFFER_BUILD_H
#define SSDO_GBUFFER_BUILD_H

#include <stdatomic.h>
#include <stdint.h>

#include "base/half.h"
#include "gbuffer/camera_header.h"
#include "gbuffer/conventions.h"
#include "gbuffer/depth_code.h"
#include "gbuffer/gbuffer.h"

// One channel seen from the frame's data window. data NULL: absent.
typedef struct plane {
    const void *data;
    sample_type type;
    int width, height; // of the channel's own part
    int dx, dy;        // frame pixel (x, y) is the part's (x + dx, y + dy)
} plane;

static inline bool plane_holds(const plane *p, int x, int y)
{
    return p->data && x + p->dx >= 0 && y + p->dy >= 0 && x + p->dx < p->width && y + p->dy < p->height;
}

// NaN outside the part's window.
static inline double plane_get(const plane *p, int x, int y)
{
    x += p->dx, y += p->dy;
    if (x < 0 || y < 0 || x >= p->width || y >= p->height) return (double)NAN;
    size_t i = (size_t)y * (size_t)p->width + (size_t)x;
    if (p->type == SAMPLE_FLOAT) return (double)((const float *)p->data)[i];
    if (p->type == SAMPLE_HALF) return (double)half_to_float(((const uint16_t *)p->data)[i]);
    return (double)((const uint32_t *)p->data)[i];
}

enum { PLANE_BLOCK = 256 }; // pixels fetched at a time, in the nearest cache

// n samples of a row from pixel x on as floats, NaN outside the part's window; p->data is there. Returns how many of those inside
// are NaN or infinite. Faster than plane_get.
size_t plane_fetch(const plane *p, int x, int y, int n, float *to);

typedef enum surface {
    SURFACE_NONE,
    SURFACE_YES,
    SURFACE_ORIGIN,  // P is exactly (0, 0, 0) with a valid depth: decided when the camera is known
    SURFACE_SETTLED, // from positions_raw on: a surface whose raw depth is the one at its pixel's centre
} surface;

// P and Z: what the file has of them, and how they are read. A `raw` depth is what P (or Z) says before it is moved onto the
// pixel's ray; 0 where there is none.
typedef struct position_evidence {
    plane p[3], z;
    bool has_p, has_z; // present and believed
    depth_code code;   // of Z
    float *raw;
    bool z_measured;      // Z is known to be planar or radial depth
    bool z_wins;          // z comes from Z
    double z_offset;      // orthographic: z = Z + offset
    double far_pixels;    // a P further than this from its pixel is not believed
    bool lateral;         // P is fine enough to tell where in its pixel it was sampled
    double rounding;      // of raw, in scene units, and
    double typical_depth; // the depth it is meant at: medians
} position_evidence;

// Where the camera stands, as far as gbuffer.camera does not say it yet.
typedef struct camera_evidence {
    bool has_pose;        // camera->world_from_camera takes P's space to camera space
    bool has_rotation;    // the camera's world_from_camera is that of a flag or of the positions
    bool has_header_pose; // else: world_from_camera is the header's, not confirmed yet
    header_pose header;
    bool rotation_from_normals; // else: the normals gave the camera's rotation; its place is unknown
    mat3 world_from_camera;     // has_header_pose or rotation_from_normals: the camera's in the end
    vec3 eye;
} camera_evidence;

// Bits: a stored normal is 1 long within a fiftieth, and within a hundredth.
enum { LENGTH_NEARLY = 1, LENGTH_WHOLE = 2 };

// N and how it is read.
typedef struct normal_evidence {
    plane n[3];
    bool there;     // present and believed
    mat3 to_camera; // takes the file's normals to camera space
    normal_encoding encoding;
    double longest;   // as stored; longer ones are damaged
    uint8_t *lengths; // of every surface's, in bits; NULL: not asked for
} normal_evidence;

// A sample of the surfaces, spread over the frame, with their Z (NaN without).
typedef struct surface_sample {
    camera_point *points;
    double *depth;
    size_t count;
    size_t candidates; // surface pixels found by classification
} surface_sample;

// What could not be used (defects.c): counted by rows on several threads.
typedef struct defect_counts {
    atomic_size_t positions;       // a surface by its depth, but P is NaN, infinite or far off its pixel
    atomic_size_t normals;         // a surface whose N is zero, NaN, infinite or absurdly long
    atomic_size_t colours;         // a sample of a colour layer that is NaN or infinite
    size_t colour_samples;         // of how many
    atomic_size_t negative_albedo; // samples below 0
} defect_counts;

typedef struct build {
    const exrio_file *file;
    const resolution *r;
    const gbuffer_options *options;
    const convention *row;
    gbuffer *g;
    log_t *log;
    error *e;

    plane alpha;
    uint8_t *surface;  // a `surface` per pixel
    unsigned filtered; // bits of the roles whose pixels are means over the pixel (damage.c)
    position_evidence position;
    camera_evidence camera;
    normal_evidence normal;
    surface_sample sample;
    defect_counts defects;
} build;

// The channel of a role's component, data NULL when it is absent or was not loaded.
plane build_plane(const build *b, role r, int component);

// Adds a line to the evidence, and to the log with -v.
void build_note(build *b, const char *format, ...) __attribute__((format(printf, 2, 3)));

// Runs fn for every row of the frame on the options' threads; rows are independent.
typedef void (*build_row_fn)(build *b, int y);
void build_rows(build *b, build_row_fn fn);

static inline size_t build_index(const build *b, int x, int y) { return (size_t)y * (size_t)b->g->width + (size_t)x; }

static inline vec3 build_position(const build *b, int x, int y)
{
    return v3(plane_get(&b->position.p[0], x, y), plane_get(&b->position.p[1], x, y), plane_get(&b->position.p[2], x, y));
}

// Z decoded to planar distance, or radial where its kind is that; NaN where it holds none.
static inline double build_depth(const build *b, int x, int y)
{
    return depth_decode(&b->position.code, plane_get(&b->position.z, x, y));
}

// Direction with z = 1 (perspective) through the centre of the pixel; orthographic: (0, 0, 1).
static inline vec3 build_ray(const camera *c, int x, int y)
{
    if (c->kind == CAMERA_ORTHOGRAPHIC) return v3(0, 0, 1);
    return v3((x + 0.5 - c->cx) / c->fx, (y + 0.5 - c->cy) / c->fy, 1.0);
}

// Camera-space position of the pixel's centre at planar depth z.
static inline vec3 build_point(const camera *c, int x, int y, double z)
{
    double s = c->kind == CAMERA_ORTHOGRAPHIC ? 1.0 : z;
    return v3((x + 0.5 - c->cx) / c->fx * s, (y + 0.5 - c->cy) / c->fy * s, z);
}

// validity.c: which pixels hold a surface, and the sample of points. May be called again when the depth is read otherwise.
bool validity_find(build *b);

// choose_camera.c: the camera by flag, fit, header or plane.
bool choose_camera(build *b);

// orthographic.c: the direction that an orthographic fit leaves open.
bool orthographic_settle(build *b);

// depth_open.c, depth_hypotheses.c. First the depth's sign, and its kind if an option gives it. Then, with the camera known, the
// kind of a depth without positions; this may classify the surfaces again. An error where depth cannot be read without a range.
bool depth_open(build *b);
bool depth_settle(build *b);

// measure.c: what Z is, and whether it or P gives the depth.
bool measure_depth(build *b);

// normal_reading.c: what the normals are, and where they put the camera.
bool measure_normals(build *b);

// damage.c: warns of filtered or lossily compressed geometry. Before positions_final.
bool damage_warn(build *b);

// positions.c: planar depth of every pixel.
bool positions_raw(build *b);
void positions_final(build *b);

// normals.c
// The file's normal at a pixel, unit, in camera space; false where it is zero or not finite.
bool normals_read(const build *b, int x, int y, vec3 *n);
// The file's normal at a pixel as it is stored; 0 where it has none or is not finite.
vec3 normals_code(const build *b, int x, int y);
// What such a value means in camera space, of the length that it decodes to.
vec3 normals_decode(const build *b, vec3 code);
// |N| as stored (for coverage); 0 when absent or not finite.
double normals_length(const build *b, int x, int y);
// The normal of the surface through the neighbours' depths, facing the eye.
vec3 normals_from_depth(const build *b, const float *depth, int x, int y);
void normals_make(build *b);

// filtered.c: gives the pixels whose depth a filter mixed one surface, after depth and normals are made. Where it is asked, it
// needs the lengths of the normals.
bool filtered_asked(const build *b);
bool filtered_mend(build *b);

// mixed.c: where the normals alone are means, gives each pixel its own surface's normal and finds gbuffer.mixed. After the
// coverage, which decides whether alpha tells anything. Where it is asked, it needs the lengths of the normals.
bool mixed_asked(const build *b);
bool mixed_make(build *b);

// The eight pixels around one; k and 7 - k are opposite.
enum { BUILD_AROUND = 8 };
extern const int build_around[BUILD_AROUND][2];

// cracks.c: after depth and normals are made.
bool cracks_mend(build *b);
// defects.c: one warning for each kind of sample that could not be used, if it touches more than a thousandth of the pixels.
void defects_warn(build *b);

// coverage.c, colours.c
bool albedo_make(build *b);   // before the coverage, which asks it
bool coverage_make(build *b); // before the other colours: a beauty that nobody sees is left out
bool colours_make(build *b);

#endif
