#include "base/mem.h"

#include <malloc.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/knobs.h"

enum { PICTURE = 1 << 16 }; // bytes from which a block counts as a picture

void mem_set_up(void)
{
    mallopt(M_MMAP_THRESHOLD, PICTURE); // also ends its growing with the blocks that are freed
}

// True when SSDO_FAIL_ALLOC names this allocation. The counter is the one piece of global state: allocations have no context.
static bool injected(void)
{
    static atomic_long count;
    const char *at = knob_value("SSDO_FAIL_ALLOC");
    return at && atomic_fetch_add(&count, 1) + 1 == atol(at);
}

static void *fail(size_t count, size_t size, error *e)
{
    err_set(e, ERR_MEMORY, NULL, NULL, "out of memory (%zu items of %zu bytes); try a smaller frame or fewer frames in flight",
            count, size);
    return NULL;
}

void *mem_zero(size_t count, size_t size, error *e)
{
    void *p = injected() ? NULL : calloc(count ? count : 1, size ? size : 1);
    return p ? p : fail(count, size, e);
}

void *mem_pixels(size_t count, size_t size, error *e)
{
    size_t bytes;
    if (__builtin_mul_overflow(count, size, &bytes) || bytes > (size_t)-64) return fail(count, size, e);
    bytes = (bytes + 63) / 64 * 64;
    void *p = injected() ? NULL : aligned_alloc(64, bytes ? bytes : 64);
    return p ? p : fail(count, size, e);
}

void *mem_grow(void *old, size_t count, size_t size, error *e)
{
    size_t bytes;
    if (__builtin_mul_overflow(count, size, &bytes)) return fail(count, size, e);
    void *p = injected() ? NULL : realloc(old, bytes ? bytes : 1);
    return p ? p : fail(count, size, e);
}

char *mem_string(const char *s, error *e)
{
    if (!s) return NULL;
    size_t n = strlen(s) + 1;
    char *copy = mem_zero(n, 1, e);
    if (copy) memcpy(copy, s, n);
    return copy;
}

size_t mem_available(void)
{
    const char *said = knob_value("SSDO_MEMORY");
    if (said && *said) return (size_t)strtoull(said, NULL, 10);
    FILE *f = fopen("/proc/meminfo", "r");
    unsigned long long kib = 0;
    char line[160];
    while (f && fgets(line, sizeof line, f))
        if (sscanf(line, "MemAvailable: %llu kB", &kib) == 1) break;
    if (f) fclose(f);
    return kib ? (size_t)kib * 1024 : SIZE_MAX;
}
