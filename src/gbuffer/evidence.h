// Sample surfaces that tell the meaning of a pass: normals of the shape itself at smooth pixels, spread over the frame and over
// the directions that the surfaces face. Internal to the room.
//
// A pixel is smooth if it is not seen edge-on and the planes through its neighbours on either side agree within 18 degrees. A
// silhouette, a crease and a leaf of two pixels are not smooth. Where values are rounded to half, neighbours further away are
// taken. If n samples face the same way, each weighs 1 / sqrt(n) and all of them sqrt(n): a floor that fills most of the picture
// does not outvote the other surfaces.
#ifndef SSDO_GBUFFER_EVIDENCE_H
#define SSDO_GBUFFER_EVIDENCE_H

#include "gbuffer/build.h"

enum { EVIDENCE_SAMPLES = 3000 };

typedef struct evidence {
    vec3 surface[EVIDENCE_SAMPLES]; // unit normal in camera space, facing the eye
    vec3 stored[EVIDENCE_SAMPLES];  // the file's normal there, as it is; NaN where the file has none
    double weight[EVIDENCE_SAMPLES];
    size_t count;
    double spread; // 1 - |weighted mean of the surface normals|^2: 0 where all face one way
} evidence;

// Camera-space position of a pixel; false where there is no surface. `context` is the caller's.
typedef bool (*evidence_point)(const build *b, const void *context, int x, int y, vec3 *p);

// `step`: how far apart neighbours are taken, in pixels. `most`: of samples, at most EVIDENCE_SAMPLES.
void evidence_gather(const build *b, evidence_point point, const void *context, int step, size_t most, evidence *out);

// The step that keeps the slope of rounded depths within about two degrees: `rounding` in scene units at depth z.
int evidence_step(const build *b, double rounding, double z);

#endif
