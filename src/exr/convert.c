#include "base/half.h"
#include "exr/write.h"

#if defined(__x86_64__) || defined(__i386__)
#include <immintrin.h>
#define HAVE_F16C 1
#endif

static const float half_max = 65504.0f;

// NaN becomes 0 and the rest is clamped to what a half holds; *changed counts.
static float sane(float f, size_t *changed)
{
    if (f >= -half_max && f <= half_max) return f;
    ++*changed;
    return f > half_max ? half_max : f < -half_max ? -half_max : 0.0f;
}

static size_t convert_plain(const float *from, size_t stride, size_t n, uint16_t *to)
{
    size_t changed = 0;
    for (size_t i = 0; i < n; i++) to[i] = float_to_half(sane(from[i * stride], &changed));
    return changed;
}

#ifdef HAVE_F16C
// The processor's own conversion rounds to nearest even as float_to_half does, at a twentieth of its cost.
__attribute__((target("avx,f16c"))) static size_t convert_f16c(const float *from, size_t stride, size_t n, uint16_t *to)
{
    const __m256 limit = _mm256_set1_ps(half_max), low = _mm256_set1_ps(-half_max);
    size_t changed = 0, i = 0;
    for (; i + 8 <= n; i += 8) {
        const float *f = from + i * stride;
        __m256 v = stride == 1 ? _mm256_loadu_ps(f)
                               : _mm256_setr_ps(f[0], f[stride], f[2 * stride], f[3 * stride], f[4 * stride], f[5 * stride],
                                                f[6 * stride], f[7 * stride]);
        __m256 number = _mm256_and_ps(v, _mm256_cmp_ps(v, v, _CMP_ORD_Q)); // NaN: 0
        __m256 r = _mm256_max_ps(_mm256_min_ps(number, limit), low);
        changed += (size_t)__builtin_popcount((unsigned)_mm256_movemask_ps(_mm256_cmp_ps(r, v, _CMP_NEQ_UQ)));
        _mm_storeu_si128((__m128i *)(to + i), _mm256_cvtps_ph(r, _MM_FROUND_TO_NEAREST_INT));
    }
    return changed + convert_plain(from + i * stride, stride, n - i, to + i);
}
#endif

size_t exrio_to_half(const float *from, size_t stride, size_t n, uint16_t *to)
{
#ifdef HAVE_F16C
    // Every processor with AVX2 has F16C, which clang 14 cannot ask for by name.
    if (__builtin_cpu_supports("avx2")) return convert_f16c(from, stride, n, to);
#endif
    return convert_plain(from, stride, n, to);
}
