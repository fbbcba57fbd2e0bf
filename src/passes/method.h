// The methods: one row each. A new method is one shader, one pass file and one row.
#ifndef SSDO_PASSES_METHOD_H
#define SSDO_PASSES_METHOD_H

#include "passes/pass.h"

typedef struct method {
    const char *name, *summary;
    const char *weighting; // of its occlusion
    const char *reach;     // of its visibility test
    const char *blind;     // what it cannot see
    int samples, blur;     // defaults
    double thickness;      // default, share of the radius
    bool fills_radiance;   // own radiance and visibility; else SH irradiance x occlusion
    bool fills_bent;       // makes the bent layer
    bool adaptive;         // can sample until an error is reached: --error
    bool fills_sh;         // makes the sh layers, and filters its samples itself
    bool needs_mesh;       // sees the scene's own surfaces: --mesh
    const char *bounce;    // its own bounce, NULL for none
    bool (*run)(pass_context *c, error *e);
} method;

extern const method methods[];               // that work from the picture alone; ends with a NULL name
extern const method method_raytrace;         // the reference, which needs the scene's mesh
const method *method_at(int i);              // all of them, from 0 on; NULL after the last
const method *method_find(const char *name); // NULL: there is none
// The names of all, in the order of the rows.
void method_names(char *text, size_t size, const char *between);
enum {
    METHOD_DEFAULT = 0, // index of the default row
    METHOD_NAMES = 256  // room for the names of all
};

#endif
