// What the fuzz targets share.
#ifndef SSDO_TESTS_FUZZ_H
#define SSDO_TESTS_FUZZ_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/error.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#define CHECK(condition)                                                                                                         \
    do {                                                                                                                         \
        if (!(condition)) {                                                                                                      \
            fprintf(stderr, "does not hold: %s\n", #condition);                                                                  \
            abort();                                                                                                             \
        }                                                                                                                        \
    } while (0)

// An error says what is wrong and names a code.
static inline void check_error(bool ok, const error *e)
{
    CHECK(ok ? e->code == ERR_NONE : e->code != ERR_NONE && e->message[0]);
}

// A file in memory with these bytes; each call of one place makes the same path. `fd` starts as -1.
static inline void fuzz_file(int *fd, char path[64], const void *data, size_t size)
{
    if (*fd < 0) *fd = memfd_create("fuzz", 0);
    snprintf(path, 64, "/proc/self/fd/%d", *fd);
    CHECK(ftruncate(*fd, 0) == 0 && pwrite(*fd, data, size, 0) == (ssize_t)size);
}

// The bytes as text, ended by a 0; the caller frees it. The part behind the first line that is only "%%" is *rest, "" if there is
// none.
static inline char *fuzz_text(const uint8_t *data, size_t size, char **rest)
{
    char *text = malloc(size + 1);
    CHECK(text);
    if (size) memcpy(text, data, size);
    text[size] = '\0';
    *rest = strstr(text, "\n%%\n");
    if (*rest)
        **rest = '\0', *rest += 4;
    else
        *rest = text + strlen(text);
    return text;
}

#endif
