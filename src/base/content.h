// What a file holds, as digests.
//
// Of a file of up to CONTENT_WHOLE bytes every byte counts. Of a larger one `sampled` takes in its length, its first bytes and
// CONTENT_BLOCKS blocks, evenly spread up to its end: it misses a change that keeps the length and touches none of these.
#ifndef SSDO_BASE_CONTENT_H
#define SSDO_BASE_CONTENT_H

#include <stdbool.h>
#include <stdint.h>

#include "base/digest.h"

enum { CONTENT_WHOLE = 1 << 22, CONTENT_BLOCKS = 64, CONTENT_BLOCK = 4096 };

typedef struct content {
    digest sampled, exact; // exact: zero unless asked for
} content;

// Where a file's head ends: so many first bytes count in any case. False with an error if the system does not let it look.
typedef bool (*content_head)(const char *path, int fd, size_t size, uint64_t *head, error *e);

// head: NULL for none. A file that does not exist, or is not a regular one, has zeroes; it is not waited for. ERR_INPUT where the
// system refuses to look: that says nothing of what the file holds.
bool content_read(const char *path, content_head head, bool exact, content *out, error *e);

#endif
