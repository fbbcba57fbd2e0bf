// IEEE half <-> float. float_to_half rounds to nearest even; values beyond the largest half (65504) become +-inf, as IEEE says:
// callers that must not write infinity clamp first (exr/write does, and counts).
#ifndef SSDO_BASE_HALF_H
#define SSDO_BASE_HALF_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

uint16_t float_to_half(float f);

// Here, so that the loops over whole pictures take it in.
static inline float half_to_float(uint16_t h)
{
    uint32_t sign = (uint32_t)(h & 0x8000u) << 16, exponent = (h >> 10) & 0x1fu, mantissa = h & 0x3ffu, bits;
    if (exponent == 31) {
        bits = sign | 0x7f800000u | (mantissa << 13);
    } else if (exponent != 0) {
        bits = sign | ((exponent + 112u) << 23) | (mantissa << 13);
    } else if (mantissa == 0) {
        bits = sign;
    } else { // subnormal half, normal float
        uint32_t shift = (uint32_t)__builtin_clz(mantissa) - 21u;
        bits = sign | ((113u - shift) << 23) | (((mantissa << shift) & 0x3ffu) << 13);
    }
    float f;
    memcpy(&f, &bits, sizeof f);
    return f;
}

// n of them, at the processor's own speed where it can.
void half_to_floats(const uint16_t *from, size_t n, float *to);

#endif
