#include "base/content.h"

#include <errno.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/infile.h"
#include "base/mem.h"

enum { BUFFER = 1 << 20, HEAD = 1 << 16 };

typedef struct source {
    const char *path;
    int fd;
    uint8_t *buffer; // BUFFER bytes
    digester *d;
    error *e;
} source;

static bool put_range(const source *s, uint64_t from, uint64_t to)
{
    while (from < to) {
        size_t want = to - from < BUFFER ? (size_t)(to - from) : BUFFER;
        if (infile_read_at(s->fd, s->buffer, want, from) != want)
            return errno ? err_set_system(s->e, ERR_INPUT, errno, s->path, "cannot be read")
                         : err_set(s->e, ERR_INPUT, s->path, NULL, "cannot be read: it became shorter meanwhile");
        digest_put(s->d, s->buffer, want);
        from += want;
    }
    return true;
}

static bool put_samples(const source *s, uint64_t head, uint64_t size)
{
    if (head < HEAD) head = HEAD;
    if (size <= CONTENT_WHOLE || head >= size) return put_range(s, 0, size);
    bool ok = put_range(s, 0, head);
    uint64_t rest = size - head, last = rest > CONTENT_BLOCK ? rest - CONTENT_BLOCK : 0;
    for (uint64_t i = 0; ok && i < CONTENT_BLOCKS; i++) {
        uint64_t at = head + last * i / (CONTENT_BLOCKS - 1);
        ok = put_range(s, at, at + CONTENT_BLOCK < size ? at + CONTENT_BLOCK : size);
    }
    return ok;
}

// One of the two digests: `all` of the bytes, or the samples.
static bool read_one(source *s, uint64_t head, uint64_t size, bool all, digest *out)
{
    s->d = digest_begin(s->e);
    if (!s->d) return false;
    digest_put(s->d, &size, sizeof size);
    bool ok = all ? put_range(s, 0, size) : put_samples(s, head, size);
    if (ok) *out = digest_of(s->d);
    digest_free(s->d);
    return ok;
}

bool content_read(const char *path, content_head head_of, bool exact, content *out, error *e)
{
    error why = {0};
    size_t size = 0;
    uint64_t head = 0;
    *out = (content){0};
    source s = {.path = path, .fd = infile_open(path, (infile_kind){NULL, ERR_INPUT}, &size, &why), .e = e};
    if (s.fd < 0) return !why.refused || err_set_system(e, why.code, why.refused, path, "cannot be opened");
    s.buffer = mem_pixels(BUFFER, 1, e);
    bool ok = s.buffer && (!head_of || head_of(path, s.fd, size, &head, e)) && read_one(&s, head, size, false, &out->sampled) &&
              (!exact || read_one(&s, head, size, true, &out->exact));
    if (!ok) *out = (content){0};
    free(s.buffer);
    close(s.fd);
    return ok;
}
