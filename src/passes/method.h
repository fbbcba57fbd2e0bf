// The methods: one row each, in the file of its name (ssdo.c holds method_ssdo), beside its run function. methods.sh collects
// the rows when the program is built, so that a new method needs an entry nowhere else (src/README.md, To add). Completion,
// --help, error texts, the manual's table and README's table come from the rows.
#ifndef SSDO_PASSES_METHOD_H
#define SSDO_PASSES_METHOD_H

#include <stdio.h>

#include "passes/pass.h"
#include "passes/variants.h"

// What a method or a bounce looks at.
typedef enum method_source {
    SEES_PICTURE = 1 << 0, // the frame's surfaces
    SEES_MESH = 1 << 1,    // the scene's own: --mesh
    SEES_ANY = SEES_PICTURE | SEES_MESH
} method_source;

// What it makes beside occlusion; bits. Without MAKES_LIGHT radiance is the SH irradiance times the occlusion.
typedef enum method_product {
    MAKES_LIGHT = 1 << 0,              // radiance and visibility
    MAKES_BENT = 1 << 1,               // the layer bent
    MAKES_ERROR = 1 << 2,              // samples until an error is reached: --error
    MAKES_LIGHT_WITHOUT_SUNS = 1 << 4, // with MAKES_LIGHT: those of the environment are left to pass_suns
    MAKES_SH = 1 << 3,                 // the layers sh_*; it filters its samples itself
} method_product;

// How occlusion weighs directions, and what blocks them. WEIGHS_OWN is a look: no closed form holds it.
typedef enum method_weight { WEIGHS_COSINE, WEIGHS_OWN } method_weight;
typedef enum method_reach {
    REACH_SURFACES, // surfaces within the radius
    REACH_POINTS,   // whatever is in front of points up to the radius
} method_reach;

// How a bounce comes to be.
typedef enum bounce_march {
    BOUNCE_AFTER,        // after the method
    BOUNCE_WITH_PICTURE, // its own method's light march makes it too, unless what bounces is that light
    BOUNCE_WITH_METHOD,  // its own method makes it always
} bounce_march;

typedef struct bounce_kind {
    const char *name; // --bounce
    method_source source;
    bounce_march march;
    bool exact;                             // the same senders for every pixel: no noise, no filter
    const variant_row *variants;            // of shaders that no method's row names; NULL: none
    bool (*run)(pass_context *c, error *e); // radiance or beauty, albedo -> indirect, unless it is there
} bounce_kind;

typedef struct method {
    const char *name;
    const char *summary;   // --help; a phrase
    const char *weighting; // the manual: of its occlusion
    const char *reaches;   // the manual: how far its visibility test reaches
    const char *blind;     // the manual: what it cannot see
    const char *light;     // README: what makes its light
    const char *choose;    // README: when to choose it
    const char *options;   // that not every method takes: names, separated by spaces
    int samples, blur;     // defaults
    double thickness;      // default, share of the radius
    unsigned makes;        // method_product
    method_source source;
    method_weight weight;
    method_reach reach;
    const bounce_kind *bounce;   // its own, NULL for none
    const variant_row *variants; // of its shaders; ends with a NULL program
    bool (*run)(pass_context *c, error *e);
    // Radiance, visibility and the bounce, those that are wanted, where `run` was not asked for them; NULL: only `run` makes
    // them.
    bool (*run_light)(pass_context *c, error *e);
} method;

extern const method *const methods[];      // the default one first, then by name; ends with NULL. Generated
extern const bounce_kind *const bounces[]; // by name; ends with NULL. Generated

// The row after `m` (NULL: the first) of those that look at one of `sources`; NULL after the last.
const method *method_next(const method *m, unsigned sources);
const method *method_find(const char *name); // NULL: there is none
const method *method_default(void);
const bounce_kind *bounce_find(const char *name); // of those that look at the picture; NULL: there is none
static inline bool method_makes(const method *m, method_product what) { return m->makes & what; }

// "arc, gtao and bitmask": the names of all that make `product` (0: of all), `last` before the last one.
void method_names(char *text, size_t size, unsigned product, const char *between, const char *last);
void bounce_names(char *text, size_t size, const char *between);
enum { METHOD_NAMES = 512 }; // room for the names

// The table of methods in the manual (mdoc) and in passes/README.md.
void methods_print_man(FILE *to);
void methods_print_markdown(FILE *to);

#endif
