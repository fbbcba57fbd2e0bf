// Passes that went through the picture's reconstruction filter: what the steps of filtered_mend share. Internal to the room.
#ifndef SSDO_GBUFFER_FILTERED_H
#define SSDO_GBUFFER_FILTERED_H

#include "gbuffer/build.h"

enum { FILTER_REACH = 4, DIRECTIONS = 8, SIDES = DIRECTIONS + 1, MOST_SIDES = 16, QUADRATURE = 24 };

// Steps to the neighbours, those along the axes first.
extern const int filtered_step[DIRECTIONS][2];

typedef struct stored {
    vec3 p;    // camera space; depth alone: (0, 0, what the file's values are linear in)
    vec3 code; // of the normal, as it is stored: what the filter took the mean of
    vec3 n;    // decoded, in camera space, of the length that this gives; 0 without
    double alpha;
    int mended; // its place in the list of the mended, from 1; 0: not among them
} stored;

// What is known of a pixel before it is read whole: bits beside those of the normal's length.
enum { PIXEL_CLEAN = 4, PIXEL_EMPTY = 8, PIXEL_WHOLE = 16 };

// Most pixels are read no further than it takes to see that they are clean. The others, and those around them, are kept once
// read.
typedef struct repair {
    build *b;
    uint8_t *state; // normal.lengths, and more
    size_t *mixed;  // the pixels that are not clean, and hold something
    size_t mixed_count;
    int *place;                  // of a pixel among those read, from 1; 0: not read yet
    stored **read;               // in blocks
    int count;                   // of pixels read
    bool failed;                 // memory was short, the error is set
    stored nothing;              // what the background stores
    bool inverse;                // depth alone whose values are linear in 1 / z
    bool radial;                 // depth alone: distance from the eye
    bool lengths;                // the normals have a length to go by
    bool has_width;              // the filter's width is known
    double width;                // its standard deviation as a Gauss in pixels; 0: a box of one pixel
    double bell[QUADRATURE + 1]; // weights of a Gauss from -3 to 3 standard deviations
} repair;

// What one of the surfaces around a pixel would store there.
typedef struct side {
    vec3 p, code, n;
    double alpha, z; // z: planar depth; 0 the background
    int u, v;        // of the clean pixel
} side;

// A pixel as a mean of two sides: near, and far behind or beside it.
typedef struct mixture {
    const side *near, *far;
    double share; // of far
    vec3 n;       // of near
    double rest;  // what is not explained, squared
} mixture;

#define NO_PIXEL SIZE_MAX

// What a mixed pixel becomes, and of which two sides it is a mean.
typedef struct mended {
    size_t pixel, near, far; // near, far: their clean pixels; NO_PIXEL the background
    double rest;             // as in mixture
    int sides;               // of how many sides around it an explanation was looked for again
    bool settled;            // followed as a round surface to its outline, or explained as well as can be expected
    bool anchor;             // one of the purest pixels of what has no clean one
    float z;
    vec3 n;
} mended;

// In the order of the pixels.
typedef struct mended_list {
    mended *items;
    size_t count;
} mended_list;

// How much what is stored differs, squared: depth in steps of `scale`, normals and alpha.
typedef struct difference {
    vec3 p, code;
    double alpha;
} difference;

typedef struct metric {
    double p, code, alpha; // of squares
} metric;

static inline difference filtered_minus(vec3 p, vec3 code, double alpha, const side *b)
{
    return (difference){v3_sub(p, b->p), v3_sub(code, b->code), alpha - b->alpha};
}

static inline double filtered_dot(const metric *w, const difference *a, const difference *b)
{
    return w->p * v3_dot(a->p, b->p) + w->code * v3_dot(a->code, b->code) + w->alpha * a->alpha * b->alpha;
}

static inline bool filtered_inside(const build *b, int x, int y)
{
    return x >= 0 && y >= 0 && x < b->g->width && y < b->g->height;
}

// One surface.
static inline bool filtered_clean(const repair *r, int x, int y)
{
    return filtered_inside(r->b, x, y) && r->state[build_index(r->b, x, y)] & PIXEL_CLEAN;
}

// What a pixel holds. The pointer stays.
stored *filtered_at(repair *r, int x, int y);
// The same, not kept: for many threads.
stored filtered_read(const repair *r, int x, int y);

// Where the surface that a pixel of these values shows lies in camera space.
vec3 filtered_place(const repair *r, const stored *s, int x, int y);

// filtered_clean.c. Finds the clean pixels, and lists those that are neither that nor empty. False, with the error set, where
// memory is short.
bool filtered_find_clean(repair *r);

// The planar depth that stored values mean, 0 where there is none; and the values of a surface at that depth.
double filtered_depth(const repair *r, vec3 p, int x, int y);
vec3 filtered_values(const repair *r, int x, int y, double z);

// filtered_mix.c. The nearest clean pixel in each direction, and the background if it is near; how many.
int filtered_sides(repair *r, int x, int y, side list[SIDES]);
// Adds the clean pixel (u, v) as it would be seen at (x, y) to `count` sides; how many there are then. Of one plane's pixels the
// nearest counts.
int filtered_add_side(repair *r, int x, int y, int u, int v, side *list, int count);
side filtered_background(const repair *r);
// What differences count; `near` is the nearest side.
metric filtered_metric(const repair *r, const side *near);
// The two of them that explain the pixel best, of which one is no earlier than `first`; rest INFINITY if none do.
mixture filtered_mixture(const repair *r, const stored *s, const side *list, int first, int count);
// The near side's normal if the far one's share is taken out, not normalised.
vec3 filtered_without(const repair *r, const stored *s, const side *far, double share);
// The far side's share, if the normal of the near one is what makes up the rest: without it, it has length 1. NaN if none does.
double filtered_share(const repair *r, const stored *s, const side *far);
// Planar depth where the ray of (x, y) meets the plane through pixel (u, v) with the normal n; the pixel's own where that is too
// oblique or leads far away.
double filtered_carried(const build *b, int u, int v, vec3 n, int x, int y);

// filtered.c. The pixel as this mixture, if it explains it.
void filtered_take(repair *r, const stored *s, const mixture *m, mended *out);
size_t filtered_clean_of(const repair *r, const side *s);

// filtered_several.c. Explains pixels again that are not explained well.
void filtered_again(repair *r, mended_list *list);

// filtered_outline.c. Measures the filter's width where round surfaces have their outlines.
void filtered_measure(repair *r);
// The near side's depth and normal at the pixel's centre, where it is a round surface that bends away at its outline. False where
// it is not, or the width is not known.
bool filtered_outline(repair *r, const stored *s, const mixture *m, int x, int y, double *z, vec3 *n);

// filtered_surface.c. What the pixel's own side is at its centre. True where it was followed there as a round surface.
bool filtered_settle(repair *r, const stored *s, const mixture *m, int x, int y, double *z, vec3 *n);

#endif
