// IEEE half <-> float. float_to_half rounds to nearest even; values beyond the largest half (65504) become +-inf, as IEEE says:
// callers that must not write infinity clamp first (exr/write does, and counts).
#ifndef SSDO_BASE_HALF_H
#define SSDO_BASE_HALF_H

#include <stdint.h>

float half_to_float(uint16_t h);
uint16_t float_to_half(float f);

#endif
