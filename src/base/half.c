#include "base/half.h"

#include <string.h>

#if defined(__x86_64__) || defined(__i386__)
#include <immintrin.h>
#define HAVE_F16C 1
#endif

uint16_t float_to_half(float f)
{
    uint32_t bits;
    memcpy(&bits, &f, sizeof bits);
    uint32_t sign = (bits >> 16) & 0x8000u, magnitude = bits & 0x7fffffffu;
    if (magnitude > 0x7f800000u) return (uint16_t)(sign | 0x7e00u | ((magnitude >> 13) & 0x3ffu));
    if (magnitude >= 0x477ff000u) return (uint16_t)(sign | 0x7c00u); // rounds beyond 65504
    if (magnitude >= 0x38800000u) {                                  // normal half
        uint32_t rounded = magnitude - 0x38000000u + 0xfffu + ((magnitude >> 13) & 1u);
        return (uint16_t)(sign | (rounded >> 13));
    }
    if (magnitude < 0x33000000u) return (uint16_t)sign;
    uint32_t shift = 126u - (magnitude >> 23), mantissa = (magnitude & 0x7fffffu) | 0x800000u;
    uint32_t result = mantissa >> shift, rest = mantissa & ((1u << shift) - 1u), tie = 1u << (shift - 1u);
    if (rest > tie || (rest == tie && (result & 1u))) result++;
    return (uint16_t)(sign | result);
}

#ifdef HAVE_F16C
__attribute__((target("avx,f16c"))) static size_t widen_f16c(const uint16_t *from, size_t n, float *to)
{
    size_t i = 0;
    for (; i + 8 <= n; i += 8) _mm256_storeu_ps(to + i, _mm256_cvtph_ps(_mm_loadu_si128((const __m128i *)(from + i))));
    return i;
}
#endif

void half_to_floats(const uint16_t *from, size_t n, float *to)
{
    size_t i = 0;
#ifdef HAVE_F16C
    // Every processor with AVX2 has F16C, which clang 14 cannot ask for by name.
    if (__builtin_cpu_supports("avx2")) i = widen_f16c(from, n, to);
#endif
    for (; i < n; i++) to[i] = half_to_float(from[i]);
}
