#include "gpu/cache.h"

#include <epoxy/gl.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/digest.h"
#include "base/mem.h"
#include "gpu/cache_file.h"

enum { MOST_BYTES = 1 << 23, MOST_PROGRAMS = 4096 };

// An entry is this and the binary. Everything in it is checked before the driver sees the bytes, and the driver checks them
// against its own build.
typedef struct entry_head {
    char magic[8];
    digest sum, key; // the sum is over all that follows it
    uint32_t format, size;
} entry_head;

static const char MAGIC[8] = "SSDOPRG2";

static digest sum_of(const entry_head *entry, size_t size)
{
    const size_t before = offsetof(entry_head, key);
    return digest_bytes((const char *)entry + before, size - before);
}

static bool make_key(const gpu *g, const char *source, digest *key)
{
    digester *d = digest_begin(NULL);
    if (!d) return false;
    digest_put_text(d, g->renderer);
    digest_put_text(d, g->version);
    digest_put_text(d, source);
    *key = digest_of(d);
    digest_free(d);
    return true;
}

bool cache_folder(char *path, size_t size)
{
    const char *base = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    int n;
    if (base && base[0] == '/') // the specification says to ignore relative ones
        n = snprintf(path, size, "%s", base);
    else if (home && home[0] == '/')
        n = snprintf(path, size, "%s/.cache", home);
    else
        return false;
    if (n < 0 || (size_t)n + sizeof "/ssdo-filter" > size) return false;
    if (mkdir(path, 0700) != 0 && errno != EEXIST) return false;
    strcat(path, "/ssdo-filter");
    return cache_own_folder(path);
}

static bool entry_path(digest key, char path[CACHE_PATH])
{
    char folder[CACHE_PATH - 48], name[DIGEST_TEXT + 1];
    if (!cache_folder(folder, sizeof folder)) return false;
    digest_format(key, name);
    snprintf(path, CACHE_PATH, "%s/%s.program", folder, name);
    return true;
}

// The whole entry, NULL if it is not there or not whole or another's.
static entry_head *read_entry(const char *path, digest key)
{
    size_t size = 0;
    entry_head *entry = cache_read(path, &size);
    if (entry && size > sizeof *entry && memcmp(entry->magic, MAGIC, sizeof MAGIC) == 0 && entry->size == size - sizeof *entry &&
        digest_equal(entry->key, key) && digest_equal(entry->sum, sum_of(entry, size)))
        return entry;
    free(entry);
    return NULL;
}

static bool have_formats(void)
{
    GLint formats = 0;
    glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
    return formats > 0;
}

bool cache_load(const gpu *g, const char *source, GLuint program)
{
    digest key;
    char path[CACHE_PATH];
    GLint linked = 0;
    if (!have_formats() || !make_key(g, source, &key) || !entry_path(key, path)) return false;
    entry_head *entry = read_entry(path, key);
    if (!entry) return false;
    glProgramBinary(program, entry->format, entry + 1, (GLsizei)entry->size);
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    while (glGetError() != GL_NO_ERROR) {} // a format of another driver is no error of ours
    free(entry);
    return linked;
}

void cache_store(const gpu *g, const char *source, GLuint program)
{
    GLint size = 0;
    GLsizei got = 0;
    GLenum format = 0;
    digest key;
    char path[CACHE_PATH];
    if (!have_formats() || !make_key(g, source, &key) || !entry_path(key, path)) return;
    glGetProgramiv(program, GL_PROGRAM_BINARY_LENGTH, &size);
    if (size <= 0 || size > MOST_BYTES) return;
    entry_head *entry = mem_zero(sizeof *entry + (size_t)size, 1, NULL);
    if (!entry) return;
    glGetProgramBinary(program, size, &got, &format, entry + 1);
    if (glGetError() == GL_NO_ERROR && got > 0) {
        memcpy(entry->magic, MAGIC, sizeof MAGIC);
        entry->key = key, entry->format = format, entry->size = (uint32_t)got;
        entry->sum = sum_of(entry, sizeof *entry + (size_t)got);
        cache_write(path, entry, sizeof *entry + (size_t)got);
    }
    free(entry);
}

static bool is_program(const char *name) { return strstr(name, ".program") != NULL; }

void cache_tidy(void)
{
    char folder[CACHE_PATH];
    if (cache_folder(folder, sizeof folder)) cache_trim(folder, is_program, MOST_PROGRAMS);
}
