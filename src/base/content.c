#include "base/content.h"

#include <stdlib.h>
#include <unistd.h>

#include "base/infile.h"
#include "base/mem.h"

enum { ROOM = 1 << 20, HEAD = 1 << 16 };

typedef struct source {
    int fd;
    uint8_t *room; // ROOM bytes
    digester *d;
} source;

static bool put_range(const source *s, uint64_t from, uint64_t to)
{
    while (from < to) {
        size_t want = to - from < ROOM ? (size_t)(to - from) : ROOM;
        if (infile_read_at(s->fd, s->room, want, from) != want) return false;
        digest_put(s->d, s->room, want);
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

static bool put_content(int fd, digester *d, uint64_t head, uint64_t size, bool all)
{
    source s = {fd, mem_pixels(ROOM, 1, NULL), d};
    digest_put(d, &size, sizeof size);
    bool ok = s.room && (all ? put_range(&s, 0, size) : put_samples(&s, head, size));
    free(s.room);
    return ok;
}

static digest read_one(int fd, uint64_t head, uint64_t size, bool all)
{
    digest result = {0};
    digester *d = digest_begin(NULL);
    if (d && put_content(fd, d, head, size, all)) result = digest_of(d);
    digest_free(d);
    return result;
}

content content_read(const char *path, uint64_t head, bool exact)
{
    content c = {0};
    error ignored = {0};
    size_t size = 0;
    int fd = infile_open(path, (infile_kind){NULL, ERR_INPUT}, &size, &ignored);
    if (fd < 0) return c;
    c.sampled = read_one(fd, head, size, false);
    if (exact) c.exact = read_one(fd, head, size, true);
    close(fd);
    return c;
}
