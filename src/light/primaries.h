// From one set of RGB primaries to another, both linear: for a map whose chromaticities attribute differs from the picture's.
#ifndef SSDO_LIGHT_PRIMARIES_H
#define SSDO_LIGHT_PRIMARIES_H

#include <stdbool.h>

#include "base/vec.h"

// xy of red, green, blue and white, two numbers each, as in OpenEXR's chromaticities (exrio_attr_chromaticities).
extern const double primaries_rec709[8];

// True if they are the same to what a float holds.
bool primaries_equal(const double a[8], const double b[8]);

// *m takes RGB of `from` to RGB of `to`. White becomes white: different white points are adapted by Bradford's matrix (Lam 1985;
// ICC specification, annex E). False when either is degenerate (three primaries on a line, a white with y = 0).
bool primaries_between(const double from[8], const double to[8], mat3 *m);

#endif
