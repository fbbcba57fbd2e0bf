// Chunk tables and leaders: OpenEXR File Layout, https://openexr.com/en/latest/OpenEXRFileLayout.html
#include <errno.h>
#include <stdlib.h>

#include "base/infile.h"
#include "base/mem.h"
#include "exr/internal.h"

enum {
    ENTRY = 8,              // bytes
    LEADER = 5 * 4 + 3 * 8, // bytes at most: a part number, four of a tile, three sizes of a deep chunk
    LEVELS = 17,            // of a side of EXRIO_MAX_SIDE pixels, down to 1
};

// How the chunks of a part are numbered.
typedef struct part_table {
    size_t first, count; // entries in the file's tables, which stand one after the other
    int lines;           // of a scanline part's chunk; 0: tiles
    bool deep;
    bool lost; // all of its entries are zero
    exr_tile_level_mode_t mode;
    int levels_x, levels_y;
    uint32_t across[LEVELS], down[LEVELS]; // tiles, by level
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

static uint64_t u64_at(const uint8_t *b) { return u32_at(b) | (uint64_t)u32_at(b + 4) << 32; }

// The number of tiles on each side of each level.
static bool lay_out_tiles(exr_const_context_t core, int part, part_table *t)
{
    uint32_t width = 0, height = 0;
    exr_tile_round_mode_t round;
    if (exr_get_tile_descriptor(core, part, &width, &height, &t->mode, &round) != EXR_ERR_SUCCESS || width < 1 || height < 1 ||
        exr_get_tile_levels(core, part, &t->levels_x, &t->levels_y) != EXR_ERR_SUCCESS || t->levels_x > LEVELS ||
        t->levels_y > LEVELS)
        return false;
    for (int i = 0; i < t->levels_x || i < t->levels_y; i++) {
        int32_t w = 1, h = 1; // of the level, in pixels; one side may have more levels than the other
        int x = i < t->levels_x ? i : 0, y = i < t->levels_y ? i : 0;
        if (exr_get_level_sizes(core, part, x, y, &w, &h) != EXR_ERR_SUCCESS || w < 1 || h < 1) return false;
        t->across[i] = ((uint32_t)w - 1) / width + 1;
        t->down[i] = ((uint32_t)h - 1) / height + 1;
    }
    return true;
}

// False: there is nothing to restore, or no way to.
static bool lay_out(restorer *s)
{
    exrio_file *f = &s->r->file;
    for (int i = 0; i < f->part_count; i++) {
        part_table *t = &s->parts[i];
        int32_t count = 0;
        if (exr_get_chunk_count(f->core, i, &count) != EXR_ERR_SUCCESS || count < 1) return false;
        t->first = s->count, t->count = (size_t)count, t->deep = f->parts[i].deep;
        s->count += t->count;
        if (f->parts[i].tiled) {
            if (!lay_out_tiles(f->core, i, t)) return false;
        } else if (exr_get_scanlines_per_chunk(f->core, i, &t->lines) != EXR_ERR_SUCCESS || t->lines < 1) {
            return false;
        }
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

// The number of a tile in its part: levels stand one after the other, those of a ripmap row by row.
static bool tile_index(const part_table *t, const uint8_t *b, uint64_t *index)
{
    uint32_t x = u32_at(b), y = u32_at(b + 4), level_x = u32_at(b + 8), level_y = u32_at(b + 12);
    uint32_t row = t->mode == EXR_TILE_RIPMAP_LEVELS ? (uint32_t)t->levels_x : 0; // 0: both sides shrink together
    if (level_x >= (uint32_t)t->levels_x || level_y >= (uint32_t)t->levels_y || (!row && level_x != level_y) ||
        x >= t->across[level_x] || y >= t->down[level_y])
        return false;
    *index = (uint64_t)y * t->across[level_x] + x;
    for (uint32_t l = 0; l < level_y * row + level_x; l++)
        *index += (uint64_t)t->across[row ? l % row : l] * t->down[row ? l / row : l];
    return true;
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
    } else if (!tile_index(t, b, &index)) {
        return NULL;
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
    const part_table *t = &s->parts[part];
    const uint8_t *place = leader + (s->numbered ? 4 : 0), *sizes = place + (t->lines ? 4 : 16);
    size_t length = (size_t)(sizes - leader) + (t->deep ? 24 : 4);
    uint8_t *entry = entry_of(s, (int)part, place);
    if (got < length || !entry) return false;
    // A deep chunk has a table of sample counts and samples, and tells what these are unpacked.
    uint64_t counts = t->deep ? u64_at(sizes) : 0, data = t->deep ? u64_at(sizes + 8) : u32_at(sizes);
    uint64_t left = s->r->size - *at - length;
    if (counts > left || data > left - counts) return false;
    if (t->lost) {
        if (!is_zero(entry, ENTRY)) return false; // it was there before
        for (int i = 0; i < ENTRY; i++) entry[i] = (uint8_t)(*at >> 8 * i);
    }
    *at += length + counts + data;
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
