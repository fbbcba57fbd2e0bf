// The format: OpenEXR File Layout, https://openexr.com/en/latest/OpenEXRFileLayout.html
#include <errno.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>

#include "base/infile.h"
#include "exr/internal.h"

enum {
    MAGIC = 20000630,
    VERSION_MASK = 0xff,
    FLAG_TILED = 0x200,
    FLAG_LONG_NAMES = 0x400,
    FLAG_DEEP = 0x800,
    FLAG_MULTIPART = 0x1000,
    FLAGS_KNOWN = FLAG_TILED | FLAG_LONG_NAMES | FLAG_DEEP | FLAG_MULTIPART,
};

typedef struct walker {
    int fd;
    const char *path;
    uint64_t size, at;
    bool multipart;
    error *e;
    uint8_t page[4096]; // the bytes from `first` on that were read last
    uint64_t first;
    size_t filled;
} walker;

typedef struct attribute {
    char name[EXRIO_MAX_NAME + 1], type[EXRIO_MAX_NAME + 1];
    uint32_t size;
} attribute;

// Attribute types of a fixed size. The library gives up in the middle of one that lies and reads on from the wrong place.
static const struct {
    const char *type;
    uint32_t size;
} fixed_sizes[] = {
    {"box2f", 16},   {"box2i", 16},   {"chromaticities", 32}, {"compression", 1}, {"double", 8}, {"envmap", 1}, {"float", 4},
    {"int", 4},      {"keycode", 28}, {"lineOrder", 1},       {"m33d", 72},       {"m33f", 36},  {"m44d", 128}, {"m44f", 64},
    {"rational", 8}, {"tiledesc", 9}, {"timecode", 8},        {"v2d", 16},        {"v2f", 8},    {"v2i", 8},    {"v3d", 24},
    {"v3f", 12},     {"v3i", 12},
};

// Attributes without which the library would make up a value, or fail.
static const struct {
    const char *name, *type;
} required[] = {
    {"channels", "chlist"},
    {"compression", "compression"},
    {"dataWindow", "box2i"},
    {"displayWindow", "box2i"},
};
enum { REQUIRED = sizeof required / sizeof *required };

static bool fail(walker *w, const char *what)
{
    return err_set(w->e, ERR_INPUT, w->path, NULL, "%s; render it or copy it again", what);
}

static bool turn_page(walker *w)
{
    uint64_t left = w->size - w->at;
    w->first = w->at;
    w->filled = left < sizeof w->page ? (size_t)left : sizeof w->page;
    return infile_read_at(w->fd, w->page, w->filled, w->first) == w->filled;
}

// At most a page of bytes.
static bool take(walker *w, void *to, size_t n)
{
    if (w->size - w->at < n) return fail(w, "is truncated: its header ends early");
    bool there = w->at >= w->first && w->at + n <= w->first + w->filled;
    if (!there && !turn_page(w))
        return errno ? err_set_system(w->e, ERR_INPUT, errno, w->path, "cannot be read")
                     : err_set(w->e, ERR_INPUT, w->path, NULL, "cannot be read: it became shorter meanwhile");
    memcpy(to, w->page + (w->at - w->first), n);
    w->at += n;
    return true;
}

static bool take_int(walker *w, uint32_t *v)
{
    uint8_t b[4];
    if (!take(w, b, sizeof b)) return false;
    *v = (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
    return true;
}

static bool take_name(walker *w, char name[EXRIO_MAX_NAME + 1])
{
    for (int i = 0; i <= EXRIO_MAX_NAME; i++) {
        if (!take(w, &name[i], 1)) return false;
        if (!name[i]) return true;
    }
    return fail(w, "is damaged: its header holds a name of more than 255 bytes");
}

static bool skip(walker *w, uint64_t n)
{
    if (w->size - w->at < n) return fail(w, "is truncated: its header ends early");
    w->at += n;
    return true;
}

// A chlist: name, pixel type, flags, x and y sampling, ..., an empty name.
static bool check_channels(walker *w, uint32_t size)
{
    uint64_t end = w->at + size;
    char name[EXRIO_MAX_NAME + 1];
    uint8_t rest[16];
    for (int i = 0; w->at < end; i++) {
        if (!take_name(w, name)) return false;
        if (!name[0]) break;
        if (i >= EXRIO_MAX_CHANNELS)
            return err_set(w->e, ERR_INPUT, w->path, NULL, "has more than %d channels in one part; split it", EXRIO_MAX_CHANNELS);
        if (!take(w, rest, sizeof rest)) return false;
    }
    return w->at == end || fail(w, "is damaged: its channel list does not have the size it claims");
}

static bool check_size(walker *w, const attribute *a)
{
    for (size_t i = 0; i < sizeof fixed_sizes / sizeof *fixed_sizes; i++)
        if (strcmp(a->type, fixed_sizes[i].type) == 0 && a->size != fixed_sizes[i].size) {
            return err_set(w->e, ERR_INPUT, w->path, NULL,
                           "is damaged: its attribute '%s' of type '%s' has %u bytes; render it or copy it again", a->name,
                           a->type, a->size);
        }
    if (a->size > INT32_MAX || a->size > w->size - w->at) return fail(w, "is truncated: an attribute reaches beyond its end");
    return true;
}

static bool refuse_deep(walker *w)
{
    return err_set(w->e, ERR_INPUT, w->path, NULL, "holds only deep data, which is not supported; flatten it first");
}

// Compressions that are newer than the library, by the first number of each.
static const struct {
    int from;
    const char *name;
} newer[] = {{10, "HTJ2K, of OpenEXR 3.4"}, {12, "ZSTD or LJ2K, of OpenEXR 3.5, or a later one"}};

static bool check_compression(walker *w)
{
    uint8_t number;
    const char *name = "";
    if (!take(w, &number, 1)) return false;
    if (number < EXR_COMPRESSION_LAST_TYPE) return true;
    for (size_t i = 0; i < sizeof newer / sizeof *newer; i++)
        if (number >= newer[i].from) name = newer[i].name;
    return err_set(w->e, ERR_INPUT, w->path, NULL,
                   "is compressed by method number %d (%s), which this build cannot read; save it with ZIP or PIZ", number, name);
}

// One attribute after its name was read. `seen` has a bit for each required one; *deep: it says so of the part.
static bool check_attribute(walker *w, attribute *a, unsigned *seen, bool *deep)
{
    if (!take_name(w, a->type) || !take_int(w, &a->size) || !check_size(w, a)) return false;
    for (unsigned i = 0; i < REQUIRED; i++) {
        if (strcmp(a->name, required[i].name) != 0) continue;
        if (strcmp(a->type, required[i].type) != 0 || (*seen & 1u << i))
            return fail(w, "is damaged: a required attribute is repeated or has the wrong type");
        *seen |= 1u << i;
    }
    if (strcmp(a->type, "chlist") == 0) return check_channels(w, a->size);
    if (strcmp(a->name, "compression") == 0) return check_compression(w);
    char type[4];
    if (strcmp(a->name, "type") != 0 || a->size < sizeof type) return skip(w, a->size);
    if (!take(w, type, sizeof type)) return false;
    *deep = memcmp(type, "deep", sizeof type) == 0;
    if (*deep && !w->multipart) return refuse_deep(w);
    return skip(w, a->size - sizeof type);
}

// Attributes up to the empty name that ends a part. *empty: there were none, which ends the list of parts.
static bool check_part(walker *w, bool *empty, bool *deep)
{
    unsigned seen = 0;
    *deep = false;
    for (int count = 0;; count++) {
        attribute a;
        if (!take_name(w, a.name)) return false;
        *empty = count == 0;
        if (!a.name[0]) break;
        if (count >= EXRIO_MAX_ATTRIBUTES) return fail(w, "is damaged: a part has more attributes than any program writes");
        if (!check_attribute(w, &a, &seen, deep)) return false;
    }
    for (unsigned i = 0; !*empty && i < REQUIRED; i++)
        if (!(seen & 1u << i))
            return err_set(w->e, ERR_INPUT, w->path, NULL,
                           "is damaged: the required attribute '%s' is missing; render it or copy it again", required[i].name);
    return true;
}

static bool check_parts(walker *w, uint32_t flags)
{
    bool empty, deep, flat = false;
    w->multipart = flags & FLAG_MULTIPART;
    if (!w->multipart) return check_part(w, &empty, &deep) && (!empty || fail(w, "is damaged: its header is empty"));
    for (int count = 0; count <= EXRIO_MAX_PARTS; count++) {
        if (!check_part(w, &empty, &deep)) return false;
        if (empty && count > 0 && !flat) return refuse_deep(w);
        if (empty) return count > 0 || fail(w, "is damaged: it has no parts");
        flat = flat || !deep;
    }
    return err_set(w->e, ERR_INPUT, w->path, NULL, "has more than %d parts; split it", EXRIO_MAX_PARTS);
}

static bool check_stream(walker *w)
{
    uint32_t magic = 0, version = 0;
    if (w->size < 8 || !take_int(w, &magic) || !take_int(w, &version) || magic != MAGIC)
        return err_set(w->e, ERR_INPUT, w->path, NULL, "is not an OpenEXR file");
    uint32_t flags = version & ~(uint32_t)VERSION_MASK;
    if ((version & VERSION_MASK) != 2 || (flags & ~(uint32_t)FLAGS_KNOWN))
        return err_set(w->e, ERR_INPUT, w->path, NULL, "is an OpenEXR file of an unknown version; save it as version 2");
    if ((flags & FLAG_DEEP) && !(flags & FLAG_MULTIPART)) return refuse_deep(w);
    return check_parts(w, flags);
}

bool exrio_check_header(const char *path, int fd, size_t size, uint64_t *end, error *e)
{
    walker w = {.fd = fd, .path = path, .size = size, .e = e};
    bool ok = check_stream(&w);
    *end = w.at;
    return ok;
}

// The table begins with the offset of a chunk, which lies behind it.
bool exrio_head_bytes(const char *path, int fd, size_t size, uint64_t *head, error *e)
{
    enum { MOST = 1 << 26 };
    error why = {0};
    uint64_t first = 0;
    uint8_t b[8] = {0};
    walker w = {.fd = fd, .path = path, .size = size, .e = &why};
    if (check_stream(&w) && take(&w, b, sizeof b))
        for (int i = 7; i >= 0; i--) first = first << 8 | b[i];
    if (why.refused) return err_set_system(e, ERR_INPUT, why.refused, path, "cannot be read");
    *head = first > w.at && first < w.size && first - w.at < MOST ? first : w.at;
    return true;
}
