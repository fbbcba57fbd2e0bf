#include "base/digest.h"

#define XXH_INLINE_ALL // no library to be found at run time
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "base/mem.h"

struct digester {
    XXH3_state_t state;
};

static digest from_hash(XXH128_hash_t h)
{
    XXH128_canonical_t c; // the same bytes whatever the machine's order
    digest d;
    XXH128_canonicalFromHash(&c, h);
    memcpy(d.bytes, c.digest, sizeof d.bytes);
    return d;
}

digester *digest_begin(error *e)
{
    digester *d = mem_pixels(1, sizeof *d, e); // aligned as the state demands
    if (d) XXH3_128bits_reset(&d->state);
    return d;
}

void digest_put(digester *d, const void *bytes, size_t size) { XXH3_128bits_update(&d->state, bytes, size); }

void digest_put_text(digester *d, const char *text)
{
    char length[24];
    int n = snprintf(length, sizeof length, "%ld ", text ? (long)strlen(text) : -1L);
    digest_put(d, length, (size_t)n);
    if (text) digest_put(d, text, strlen(text));
}

digest digest_of(const digester *d) { return from_hash(XXH3_128bits_digest(&d->state)); }

void digest_free(digester *d) { free(d); }

digest digest_bytes(const void *bytes, size_t size) { return from_hash(XXH3_128bits(bytes, size)); }

bool digest_equal(digest a, digest b) { return memcmp(a.bytes, b.bytes, sizeof a.bytes) == 0; }

void digest_format(digest d, char text[DIGEST_TEXT + 1])
{
    for (int i = 0; i < 16; i++) snprintf(text + 2 * i, 3, "%02x", d.bytes[i]);
}
