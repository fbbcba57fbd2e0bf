// Checked allocation. Every allocation of ours goes through here, so that exhaustion can be injected in tests:
// the environment variable SSDO_FAIL_ALLOC=n makes the n-th allocation of the process fail.
#ifndef SSDO_BASE_MEM_H
#define SSDO_BASE_MEM_H

#include <stddef.h>

#include "base/error.h"

// To be called once, before the first thread starts: pictures are taken from the system and given back to it one by one. Left to
// itself the C library keeps freed pictures for later ones, of other sizes and on other threads, and a batch grows from frame to
// frame.
void mem_set_up(void);

// count * size zeroed bytes, or NULL with ERR_MEMORY (also when the product overflows). count 0 gives a valid pointer.
void *mem_zero(size_t count, size_t size, error *e);
// The same, uninitialised and aligned to 64 bytes, for pixel data. Freed with free().
void *mem_pixels(size_t count, size_t size, error *e);
// realloc that never loses the old block on failure: returns NULL and leaves `old` valid.
void *mem_grow(void *old, size_t count, size_t size, error *e);
// A copy of a string (NULL gives NULL without an error).
char *mem_string(const char *s, error *e);

// Bytes that can be allocated without swapping: MemAvailable of /proc/meminfo, or what the environment variable SSDO_MEMORY says
// (for tests). SIZE_MAX where nobody knows.
size_t mem_available(void);

#endif
