// 128 bits that stand for any number of bytes: XXH3, the same on every machine. Against accidents, not against forgers.
#ifndef SSDO_BASE_DIGEST_H
#define SSDO_BASE_DIGEST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"

enum { DIGEST_TEXT = 32 }; // hexadecimal digits

typedef struct digest {
    uint8_t bytes[16];
} digest;

// Grows by what is put into it; a digest is taken of all so far.
typedef struct digester digester;

digester *digest_begin(error *e); // NULL with ERR_MEMORY; to be freed with digest_free
void digest_put(digester *d, const void *bytes, size_t size);
// A string with its length in front, so that "ab" "c" is not "a" "bc". NULL differs from "".
void digest_put_text(digester *d, const char *text);
digest digest_of(const digester *d);
void digest_free(digester *d); // NULL is allowed

digest digest_bytes(const void *bytes, size_t size);
bool digest_equal(digest a, digest b);
void digest_format(digest d, char text[DIGEST_TEXT + 1]);

#endif
