// Reference A of a whole method: which of the brute-force references (reference.h) belongs to a row of the method table, and with
// which options, so that tests and bench hold a method to the same thing.
#ifndef SSDO_TESTS_METHOD_REFERENCE_H
#define SSDO_TESTS_METHOD_REFERENCE_H

#include "light/environment.h"
#include "passes/method.h"
#include "reference.h"

typedef struct method_reference_options {
    const method *method;
    const pass_settings *set; // radius, thickness, angle_bias, sh_sigma, scale, contrast
    const environment *env;   // for the radiance; NULL: none is made
    bool fine;                // several times the quadrature points
} method_reference_options;

typedef struct method_reference_value {
    double occlusion;
    vec3 radiance; // where method_references_light
} method_reference_value;

// arc has none: what its runs are is not defined without its steps.
bool method_has_reference(const method *m);
// ssdo: the sky, blurred over the solid angle of a direction of the quadrature. s3ho: the sky of nine coefficients.
bool method_references_light(const method *m);

method_reference_value method_reference(const layer *l, pixel p, const method_reference_options *o);

// The bounce of endless virtual lights (--bounce vpl): every pixel of the layer a disc of its own area that sends albedo x
// `radiance` (3 a pixel), min(1, 1 / sum F) times the sum of F = A cos cos / (pi d^2 + A). Needs the layer's albedo.
vec3 reference_vpl(const layer *l, pixel p, const float *radiance);

#endif
