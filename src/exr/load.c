#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/threads.h"
#include "exr/codec.h"
#include "exr/internal.h"
#include "exr/library.h"
#include "plugin/dwa.h"
#include "plugin/module.h"

typedef struct load_worker {
    exr_decode_pipeline_t pipeline;
    bool ready; // pipeline is initialised
    codec codec;
    void *dwa; // the module's decoder
} load_worker;

typedef struct load_job {
    exrio_file *file;
    int index; // of the part
    exrio_part *part;
    exr_chunk_info_t *chunks;
    size_t chunk_count;
    int tile_width, tile_height, tiles_across; // scanline parts: the whole width, lines per chunk, 1
    load_worker *workers;
    bool *fresh;          // by channel: this load brings it
    dwa_module dwa;       // where the library does not decode the part
    dwa_source source;    // what it reads
    pthread_mutex_t lock; // of error
    error *error;
} load_job;

static const char damaged[] = "is truncated or damaged; render it or copy it again";

static core_log *log_of(const load_job *j) { return &((exrio_reader *)j->file)->log; }

static bool fail(load_job *j, exr_result_t code)
{
    pthread_mutex_lock(&j->lock);
    core_log_report(log_of(j), code, ERR_INPUT, j->file->path, damaged, j->error);
    pthread_mutex_unlock(&j->lock);
    return false;
}

// Counts the chunks of level 0 and how they lie in the image.
static bool lay_out(load_job *j)
{
    const exrio_part *p = j->part;
    size_t w = (size_t)box2_width(p->data_window), h = (size_t)box2_height(p->data_window);
    exr_result_t rv;
    if (p->tiled) {
        uint32_t tx = 0, ty = 0;
        exr_tile_level_mode_t level;
        exr_tile_round_mode_t round;
        rv = exr_get_tile_descriptor(j->file->core, j->index, &tx, &ty, &level, &round);
        j->tile_width = (int)tx;
        j->tile_height = (int)ty;
    } else {
        int32_t lines = 0;
        rv = exr_get_scanlines_per_chunk(j->file->core, j->index, &lines);
        j->tile_width = (int)w;
        j->tile_height = lines;
    }
    if (rv != EXR_ERR_SUCCESS || j->tile_width < 1 || j->tile_height < 1) return fail(j, rv ? rv : EXR_ERR_FILE_BAD_HEADER);
    size_t tw = (size_t)j->tile_width, th = (size_t)j->tile_height;
    j->tiles_across = (int)((w + tw - 1) / tw);
    j->chunk_count = (size_t)j->tiles_across * ((h + th - 1) / th);
    return true;
}

// Reads where chunk `item` is and checks its leader.
static bool read_leader(load_job *j, size_t item, exr_chunk_info_t *c)
{
    const exrio_part *p = j->part;
    int tx = (int)(item % (size_t)j->tiles_across), ty = (int)(item / (size_t)j->tiles_across);
    exr_result_t rv = p->tiled
                          ? exr_read_tile_chunk_info(j->file->core, j->index, tx, ty, 0, 0, c)
                          : exr_read_scanline_chunk_info(j->file->core, j->index, p->data_window.y0 + ty * j->tile_height, c);
    if (rv != EXR_ERR_SUCCESS) return fail(j, rv);
    uint64_t pixel = 0;
    for (int i = 0; i < p->channel_count; i++) pixel += sample_size(p->channels[i].type);
    // 3.1.5 lets a short chunk of an uncompressed part through, and one larger than its contents.
    if (c->unpacked_size != pixel * (uint64_t)c->width * (uint64_t)c->height || c->packed_size > c->unpacked_size ||
        (p->compression == EXR_COMPRESSION_NONE && c->packed_size != c->unpacked_size))
        return fail(j, EXR_ERR_BAD_CHUNK_LEADER);
    return true;
}

static bool probe_last_chunk(load_job *j)
{
    exr_chunk_info_t unused;
    return read_leader(j, j->chunk_count - 1, &unused);
}

// For all chunks before any memory for pixels is taken.
static bool find_chunk(void *context, size_t item, int worker)
{
    (void)worker;
    load_job *j = context;
    return read_leader(j, item, &j->chunks[item]);
}

// Channels that an earlier load brought are left alone: somebody may be reading them.
static void point_channels(const load_job *j, const exr_chunk_info_t *c, exr_decode_pipeline_t *d)
{
    const exrio_part *p = j->part;
    size_t width = (size_t)box2_width(p->data_window);
    size_t x = p->tiled ? (size_t)c->start_x * (size_t)j->tile_width : 0;
    size_t y = p->tiled ? (size_t)c->start_y * (size_t)j->tile_height : (size_t)(c->start_y - p->data_window.y0);
    for (int i = 0; i < d->channel_count; i++) {
        const exrio_channel *ch = &p->channels[i];
        size_t size = sample_size(ch->type);
        d->channels[i].user_line_stride = (int32_t)(width * size);
        d->channels[i].user_pixel_stride = (int32_t)size;
        d->channels[i].decode_to_ptr = j->fresh[i] ? (uint8_t *)ch->data + (y * width + x) * size : NULL;
    }
}

static bool decode_chunk(void *context, size_t item, int worker)
{
    load_job *j = context;
    load_worker *w = &j->workers[worker];
    const exr_chunk_info_t *c = &j->chunks[item];
    exr_result_t rv;
    if (w->ready) {
        rv = exr_decoding_update(j->file->core, j->index, c, &w->pipeline);
    } else {
        rv = exr_decoding_initialize(j->file->core, j->index, c, &w->pipeline);
        w->ready = rv == EXR_ERR_SUCCESS;
        if (w->ready) rv = codec_attach_decoder(&w->codec, j->file->core, j->index, &w->pipeline);
    }
    if (rv != EXR_ERR_SUCCESS) return fail(j, rv);
    point_channels(j, c, &w->pipeline);
    rv = exr_decoding_run(j->file->core, j->index, &w->pipeline);
    return rv == EXR_ERR_SUCCESS || fail(j, rv);
}

static bool take_memory(load_job *j)
{
    exrio_part *p = j->part;
    size_t count = (size_t)box2_width(p->data_window) * (size_t)box2_height(p->data_window);
    for (int i = 0; i < p->channel_count; i++) {
        exrio_channel *c = &p->channels[i];
        if (!c->wanted || c->data) continue;
        c->data = mem_pixels(count, sample_size(c->type), j->error);
        if (!c->data) return false;
        j->fresh[i] = true;
    }
    return true;
}

// --- what the library does not decode ---

static size_t read_source(void *context, void *to, size_t n, uint64_t offset) { return exrio_read_bytes(context, to, n, offset); }

static bool check_dwa(load_job *j, dwa_result result, const char *message)
{
    if (result == DWA_OK) return true;
    core_log_keep(log_of(j), message);
    return fail(j, result == DWA_MEMORY ? EXR_ERR_OUT_OF_MEMORY : EXR_ERR_CORRUPT_CHUNK);
}

// The channels that this load brings; returns how many.
static int list_dwa_channels(const load_job *j, dwa_channel *out)
{
    int count = 0;
    for (int i = 0; i < j->part->channel_count; i++) {
        const exrio_channel *c = &j->part->channels[i];
        if (j->fresh[i]) out[count++] = (dwa_channel){c->stored ? c->stored : c->name, (int)c->type, c->data};
    }
    return count;
}

// One row of chunks.
static bool decode_row(void *context, size_t item, int worker)
{
    load_job *j = context;
    load_worker *w = &j->workers[worker];
    const box2 window = j->part->data_window;
    const dwa_part part = {j->index, window.x0, window.y0, window.x1, window.y1};
    int first = window.y0 + (int)item * j->tile_height, last = first + j->tile_height - 1;
    char message[MODULE_MESSAGE] = "";
    dwa_channel channels[EXRIO_MAX_CHANNELS];
    if (!w->dwa && !check_dwa(j, j->dwa.open(&j->source, &part, &w->dwa, message, sizeof message), message)) return false;
    int count = list_dwa_channels(j, channels);
    return check_dwa(
        j, j->dwa.decode(w->dwa, channels, count, first, last < window.y1 ? last : window.y1, message, sizeof message), message);
}

// --- a part ---

static bool decode_all(load_job *j, int threads)
{
    size_t rows = j->chunk_count / (size_t)j->tiles_across;
    return j->dwa.open ? threads_for(threads, rows, decode_row, j) : threads_for(threads, j->chunk_count, decode_chunk, j);
}

static bool decode_part(load_job *j, int threads)
{
    bool ok = false;
    if (threads < 1) threads = 1;
    core_log_arm(log_of(j));
    // The last chunk's place is in the chunk table, which the library checks against the file's size: now the table is known
    // to be as long as the header says.
    if (!lay_out(j) || !probe_last_chunk(j)) return false;
    j->chunks = mem_zero(j->chunk_count, sizeof *j->chunks, j->error);
    j->workers = mem_zero((size_t)threads, sizeof *j->workers, j->error);
    if (j->chunks && j->workers && threads_for(threads, j->chunk_count, find_chunk, j) && take_memory(j))
        ok = decode_all(j, threads);
    for (int i = 0; j->workers && i < threads; i++) {
        if (j->workers[i].ready) exr_decoding_destroy(j->file->core, &j->workers[i].pipeline);
        if (j->workers[i].dwa) j->dwa.close(j->workers[i].dwa);
        codec_free(&j->workers[i].codec);
    }
    free(j->workers);
    free(j->chunks);
    return ok;
}

static bool load_part(exrio_file *file, int index, int threads, bool *fresh, error *e)
{
    exrio_part *p = &file->parts[index];
    bool any = false;
    if (p->deep) return true;
    for (int i = 0; i < p->channel_count; i++) any |= p->channels[i].wanted && !p->channels[i].data;
    if (!any) return true;
    exrio_reader *r = (exrio_reader *)file;
    load_job j = {.file = file, .index = index, .part = p, .fresh = fresh, .error = e, .source = {r, r->size, read_source}};
    if (!exrio_library_decodes(p->compression) && !dwa_module_open(file->path, &j.dwa, e)) return false;
    pthread_mutex_init(&j.lock, NULL);
    bool ok = decode_part(&j, threads);
    pthread_mutex_destroy(&j.lock);
    return ok;
}

bool exrio_file_load(exrio_file *file, int threads, error *e)
{
    size_t total = 0, at = 0;
    bool ok = true;
    if (file->members) { // whose channels are the same as ours
        for (int i = 0; ok && i < file->member_count; i++) ok = exrio_file_load(file->members[i], threads, e);
        return ok;
    }
    for (int i = 0; i < file->part_count; i++) total += (size_t)file->parts[i].channel_count;
    bool *fresh = mem_zero(total, sizeof *fresh, e); // channels that this call brings
    if (!fresh) return false;
    for (int i = 0; ok && i < file->part_count; i++) {
        ok = load_part(file, i, threads, fresh + at, e);
        at += (size_t)file->parts[i].channel_count;
    }
    at = 0;
    for (int i = 0; !ok && i < file->part_count; i++)
        for (int c = 0; c < file->parts[i].channel_count; c++, at++) {
            if (!fresh[at]) continue;
            free(file->parts[i].channels[c].data);
            file->parts[i].channels[c].data = NULL;
        }
    free(fresh);
    return ok;
}
