// Chunk tables and leaders: OpenEXR File Layout, https://openexr.com/en/latest/OpenEXRFileLayout.html
#include <errno.h>
#include <stdlib.h>

#include "base/infile.h"
#include "base/mem.h"
#include "exr/internal.h"

enum { ENTRY = 8, LEADER = 6 * 4 }; // bytes; a leader has at most a part number, four of a tile, and a size

// How the chunks of a part are numbered.
typedef struct part_table {
    size_t first, count; // entries in the file's tables, which stand one after the other
    int lines;           // of a scanline part's chunk; 0: tiles
    uint32_t tiles_across;
    bool lost; // all of its entries are zero
} part_table;

typedef struct restorer {
    exrio_reader *r;
    part_table *parts;
    uint8_t *entries; // the tables of all parts
    size_t count;     // of entries
    bool numbered;    // each chunk says its part
    int refused;      // errno of the first read that the system refused
} restorer;

static uint32_t u32_at(const uint8_t *b)
{
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static bool is_zero(const uint8_t *b, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (b[i]) return false;
    return true;
}

// False: there is nothing to restore, or no way to.
static bool lay_out(restorer *s)
{
    exrio_file *f = &s->r->file;
    for (int i = 0; i < f->part_count; i++) {
        part_table *t = &s->parts[i];
        int32_t count = 0;
        if (f->parts[i].deep || exr_get_chunk_count(f->core, i, &count) != EXR_ERR_SUCCESS || count < 1) return false;
        t->first = s->count, t->count = (size_t)count;
        s->count += t->count;
        if (!f->parts[i].tiled) {
            if (exr_get_scanlines_per_chunk(f->core, i, &t->lines) != EXR_ERR_SUCCESS || t->lines < 1) return false;
            continue;
        }
        uint32_t width = 0, height = 0;
        exr_tile_level_mode_t level;
        exr_tile_round_mode_t round;
        exr_result_t rv = exr_get_tile_descriptor(f->core, i, &width, &height, &level, &round);
        if (rv != EXR_ERR_SUCCESS || level != EXR_TILE_ONE_LEVEL || width < 1) return false;
        t->tiles_across = ((uint32_t)box2_width(f->parts[i].data_window) + width - 1) / width;
    }
    return s->r->tables <= s->r->size && s->count <= (s->r->size - s->r->tables) / ENTRY;
}

static size_t get(restorer *s, void *to, size_t n, uint64_t offset)
{
    size_t got = infile_read_at(s->r->fd, to, n, offset);
    if (errno && !s->refused) s->refused = errno;
    return got;
}

// Most files are known to be whole by one entry of each part.
static bool begins_with_zero(restorer *s)
{
    uint8_t entry[ENTRY];
    for (int i = 0; i < s->r->file.part_count; i++) {
        uint64_t at = s->r->tables + ENTRY * s->parts[i].first;
        if (get(s, entry, ENTRY, at) == ENTRY && is_zero(entry, ENTRY)) return true;
    }
    return false;
}

static bool find_lost(restorer *s)
{
    bool any = false;
    if (get(s, s->entries, ENTRY * s->count, s->r->tables) != ENTRY * s->count) return false;
    for (int i = 0; i < s->r->file.part_count; i++) {
        part_table *t = &s->parts[i];
        t->lost = is_zero(s->entries + ENTRY * t->first, ENTRY * t->count);
        any = any || t->lost;
    }
    return any;
}

// The entry of the chunk whose leader, after the part number, is `b`; NULL if there is no such chunk.
static uint8_t *entry_of(const restorer *s, int part, const uint8_t *b)
{
    const part_table *t = &s->parts[part];
    uint64_t index;
    if (t->lines) {
        int64_t y = (int64_t)(int32_t)u32_at(b) - s->r->file.parts[part].data_window.y0;
        if (y < 0 || y % t->lines) return NULL;
        index = (uint64_t)(y / t->lines);
    } else {
        if (u32_at(b) >= t->tiles_across || !is_zero(b + 8, 8)) return NULL;
        index = (uint64_t)u32_at(b + 4) * t->tiles_across + u32_at(b);
    }
    return index < t->count ? s->entries + ENTRY * (t->first + index) : NULL;
}

// Puts the chunk at *at into its table, and *at behind it.
static bool take_chunk(restorer *s, uint64_t *at)
{
    uint8_t leader[LEADER] = {0};
    if (*at >= s->r->size) return false;
    size_t got = get(s, leader, LEADER, *at);
    uint32_t part = s->numbered ? u32_at(leader) : 0;
    if (part >= (uint32_t)s->r->file.part_count) return false;
    const uint8_t *place = leader + (s->numbered ? 4 : 0), *size = place + (s->parts[part].lines ? 4 : 16);
    size_t length = (size_t)(size + 4 - leader);
    uint8_t *entry = entry_of(s, (int)part, place);
    if (got < length || !entry || u32_at(size) > s->r->size - *at - length) return false;
    if (s->parts[part].lost) {
        if (!is_zero(entry, ENTRY)) return false; // it was there before
        for (int i = 0; i < ENTRY; i++) entry[i] = (uint8_t)(*at >> 8 * i);
    }
    *at += length + u32_at(size);
    return true;
}

static bool take_chunks(restorer *s)
{
    uint64_t at = s->r->tables + ENTRY * s->count;
    for (size_t i = 0; i < s->count; i++)
        if (!take_chunk(s, &at)) return false;
    for (int i = 0; i < s->r->file.part_count; i++)
        for (size_t k = 0; k < s->parts[i].count; k++)
            if (is_zero(s->entries + ENTRY * (s->parts[i].first + k), ENTRY)) return false;
    return true;
}

bool exrio_restore_tables(exrio_reader *r, error *e)
{
    restorer s = {.r = r};
    uint8_t flags = 0;
    bool ok = false;
    s.parts = mem_zero((size_t)r->file.part_count, sizeof *s.parts, e);
    if (!s.parts) goto out;
    ok = true;
    s.numbered = get(&s, &flags, 1, 5) == 1 && flags & 0x10; // of the version field: multi-part
    if (!lay_out(&s) || !begins_with_zero(&s)) goto out;
    s.entries = mem_zero(s.count, ENTRY, e);
    ok = s.entries != NULL;
    if (!ok || !find_lost(&s) || !take_chunks(&s)) goto out;
    r->restored = s.entries, r->restored_size = ENTRY * s.count;
    s.entries = NULL;
out:
    if (s.refused) ok = err_set_system(e, ERR_INPUT, s.refused, r->file.path, "cannot be read");
    free(s.parts);
    free(s.entries);
    return ok;
}
