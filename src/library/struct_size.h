// Structs of the caller's that begin with their own size: what it knows is taken, the rest is 0.
#ifndef SSDO_LIBRARY_STRUCT_SIZE_H
#define SSDO_LIBRARY_STRUCT_SIZE_H

#include <stddef.h>
#include <string.h>

#include "base/error.h"

// Copies *from, which begins with its size, to `to`, which has room for `size` bytes. ERR_USAGE for a size that no version ever
// had: less than itself, or more than this one's, of which nobody knows what it asks for.
static inline bool struct_take(void *to, size_t size, const void *from, const char *name, error *e)
{
    size_t given = 0;
    if (from) memcpy(&given, from, sizeof given);
    if (given <= sizeof given || given > size)
        return err_set(e, ERR_USAGE, NULL, NULL, "%s.size is %zu and must be sizeof(%s), %zu here", name, given, name, size);
    memset(to, 0, size);
    memcpy(to, from, given);
    return true;
}

#endif
