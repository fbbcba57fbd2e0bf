#include "exr/write.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/mem.h"
#include "base/outfile.h"
#include "base/threads.h"
#include "exr/codec.h"
#include "exr/deep.h"
#include "exr/internal.h"

enum { DEFAULT_LEVEL = 1, MAX_LEVEL = 12 }; // libdeflate's; 1 costs a fifth of zlib's 6 for 1.5 % more bytes

typedef struct write_worker {
    exr_encode_pipeline_t pipeline;
    bool ready; // pipeline is initialised
    codec codec;
    void *raw; // a verbatim chunk
    size_t raw_size, raw_room;
    int raw_line; // its first
} write_worker;

// Chunks are encoded as threads come to them and written in order: a thread that is done waits for its chunk's turn. One chunk a
// thread is in memory, and the one whose turn it is is always being worked on, because chunks are handed out in order.
typedef struct write_job {
    exr_context_t core;
    int index; // of the part
    const exrio_out_part *part;
    const exrio_out_channel **channels; // sorted by name, as the library has them
    int lines;                          // per chunk
    write_worker *workers;
    pthread_mutex_t lock;
    pthread_cond_t turn_changed;
    size_t turn;
    exr_result_t result; // the first failure
} write_job;

// --- the library's callbacks ---

static void ignore_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    (void)code;
    (void)message; // called with the library's lock held; the result says enough
}

static int64_t write_bytes(exr_const_context_t context, void *user, const void *buffer, uint64_t size, uint64_t offset,
                           exr_stream_error_func_ptr_t report)
{
    (void)context;
    (void)report;
    return outfile_put(user, buffer, size, offset) ? (int64_t)size : -1;
}

static void *core_allocate(size_t size) { return mem_zero(size, 1, NULL); }
static void core_free(void *p) { free(p); }

// --- chunks ---

static bool fail(write_job *j, exr_result_t rv)
{
    pthread_mutex_lock(&j->lock);
    if (j->result == EXR_ERR_SUCCESS) j->result = rv;
    pthread_cond_broadcast(&j->turn_changed);
    pthread_mutex_unlock(&j->lock);
    return false;
}

static exr_result_t point_channels(const write_job *j, exr_encode_pipeline_t *p)
{
    size_t width = (size_t)box2_width(j->part->data_window);
    size_t first = (size_t)(p->chunk.start_y - j->part->data_window.y0) * width;
    if (p->channel_count != j->part->channel_count) return EXR_ERR_INVALID_ARGUMENT;
    for (int i = 0; i < p->channel_count; i++) {
        const exrio_out_channel *c = j->channels[i];
        size_t size = sample_size(c->type);
        if (strcmp(c->name, p->channels[i].channel_name) != 0) return EXR_ERR_INVALID_ARGUMENT;
        p->channels[i].user_pixel_stride = (int32_t)size;
        p->channels[i].user_line_stride = (int32_t)(width * size);
        p->channels[i].encode_from_ptr = (const uint8_t *)c->data + first * size;
    }
    return EXR_ERR_SUCCESS;
}

static exr_result_t encode(write_job *j, write_worker *w, size_t item)
{
    exr_chunk_info_t info;
    int y = j->part->data_window.y0 + (int)item * j->lines;
    exr_result_t rv = exr_write_scanline_chunk_info(j->core, j->index, y, &info);
    if (rv != EXR_ERR_SUCCESS) return rv;
    if (w->ready) {
        rv = exr_encoding_update(j->core, j->index, &info, &w->pipeline);
    } else {
        rv = exr_encoding_initialize(j->core, j->index, &info, &w->pipeline);
        w->ready = rv == EXR_ERR_SUCCESS;
        w->codec.level = j->part->level < 1 ? DEFAULT_LEVEL : j->part->level > MAX_LEVEL ? MAX_LEVEL : j->part->level;
        if (w->ready) rv = codec_attach_encoder(&w->codec, j->core, j->index, &w->pipeline);
    }
    if (rv == EXR_ERR_SUCCESS) rv = point_channels(j, &w->pipeline);
    return rv == EXR_ERR_SUCCESS ? exr_encoding_run(j->core, j->index, &w->pipeline) : rv;
}

// The chunk as the input stores it. Chunks of equal windows and compression cover the same lines.
static exr_result_t fetch_verbatim(write_job *j, write_worker *w, size_t item)
{
    exr_chunk_info_t info;
    exr_const_context_t in = j->part->attributes_from->core;
    int y = j->part->data_window.y0 + (int)item * j->lines;
    exr_result_t rv = exr_read_scanline_chunk_info(in, j->part->attributes_part, y, &info);
    if (rv != EXR_ERR_SUCCESS) return rv;
    if (info.packed_size > w->raw_room) {
        void *grown = mem_grow(w->raw, info.packed_size, 1, NULL);
        if (!grown) return EXR_ERR_OUT_OF_MEMORY;
        w->raw = grown;
        w->raw_room = info.packed_size;
    }
    w->raw_size = info.packed_size;
    w->raw_line = info.start_y;
    return exr_read_chunk(in, j->part->attributes_part, &info, w->raw);
}

static exr_result_t put_chunk(const write_job *j, const write_worker *w)
{
    const exr_encode_pipeline_t *p = &w->pipeline;
    if (j->part->verbatim) return exr_write_scanline_chunk(j->core, j->index, w->raw_line, w->raw, w->raw_size);
    return exr_write_scanline_chunk(j->core, j->index, p->chunk.start_y, p->compressed_buffer, p->compressed_bytes);
}

static bool write_chunk(void *context, size_t item, int worker)
{
    write_job *j = context;
    write_worker *w = &j->workers[worker];
    exr_result_t rv = j->part->verbatim ? fetch_verbatim(j, w, item) : encode(j, w, item);
    if (rv != EXR_ERR_SUCCESS) return fail(j, rv);
    pthread_mutex_lock(&j->lock);
    while (j->turn != item && j->result == EXR_ERR_SUCCESS) pthread_cond_wait(&j->turn_changed, &j->lock);
    bool ok = j->result == EXR_ERR_SUCCESS;
    pthread_mutex_unlock(&j->lock);
    if (!ok) return false;
    rv = put_chunk(j, w);
    if (rv != EXR_ERR_SUCCESS) return fail(j, rv);
    pthread_mutex_lock(&j->lock);
    j->turn++;
    pthread_cond_broadcast(&j->turn_changed);
    pthread_mutex_unlock(&j->lock);
    return true;
}

static int compare_channels(const void *a, const void *b)
{
    const exrio_out_channel *const *ca = a, *const *cb = b;
    return strcmp((*ca)->name, (*cb)->name);
}

static bool prepare(write_job *j, int threads, error *e)
{
    size_t n = (size_t)j->part->channel_count;
    j->channels = mem_zero(n, sizeof *j->channels, e);
    j->workers = mem_zero((size_t)threads, sizeof *j->workers, e);
    if (!j->channels || !j->workers) return false;
    for (size_t i = 0; i < n; i++) j->channels[i] = &j->part->channels[i];
    qsort(j->channels, n, sizeof *j->channels, compare_channels);
    return true;
}

static exr_result_t write_part(exr_context_t core, int index, const exrio_out_part *part, int threads, error *e)
{
    write_job j = {.core = core, .index = index, .part = part};
    pthread_mutex_init(&j.lock, NULL);
    pthread_cond_init(&j.turn_changed, NULL);
    int32_t lines = 1, chunks = 0;
    exr_result_t rv = prepare(&j, threads, e) ? EXR_ERR_SUCCESS : EXR_ERR_OUT_OF_MEMORY;
    if (rv == EXR_ERR_SUCCESS) rv = exr_get_scanlines_per_chunk(core, index, &lines);
    if (rv == EXR_ERR_SUCCESS) rv = exr_get_chunk_count(core, index, &chunks);
    j.lines = lines;
    if (rv == EXR_ERR_SUCCESS && part->deep)
        rv = deep_copy(core, index, part, lines, chunks, e);
    else if (rv == EXR_ERR_SUCCESS && !threads_for(threads, (size_t)chunks, write_chunk, &j))
        rv = j.result;
    for (int i = 0; j.workers && i < threads; i++) {
        if (j.workers[i].ready) exr_encoding_destroy(core, &j.workers[i].pipeline);
        codec_free(&j.workers[i].codec);
        free(j.workers[i].raw);
    }
    free(j.workers);
    free(j.channels);
    pthread_cond_destroy(&j.turn_changed);
    pthread_mutex_destroy(&j.lock);
    return rv;
}

// --- the file ---

static bool report(exr_result_t rv, const outfile *file, const char *path, error *e)
{
    if (rv == EXR_ERR_OUT_OF_MEMORY)
        return err_set(e, ERR_MEMORY, path, NULL, "out of memory while writing; try fewer threads or frames in flight");
    if (file->code)
        return err_set(e, ERR_OUTPUT, path, NULL, "cannot be written: %s; free some space or choose another output",
                       strerror(file->code));
    return err_set(e, ERR_OUTPUT, path, NULL, "cannot be written as OpenEXR (%s); try --keep none",
                   exr_get_default_error_message(rv));
}

// From the disk and not from memory, as far as the system lets itself be asked.
static bool inspect(const exrio_inspector *inspector, const outfile *file, error *e)
{
    if (!inspector) return true;
    (void)!fsync(file->fd); // committing says what this may say
    (void)!posix_fadvise(file->fd, 0, 0, POSIX_FADV_DONTNEED);
    return inspector->look(inspector->context, file->temp, e);
}

static exr_result_t write_parts(outfile *file, const char *name, const exrio_out_part *parts, int part_count, int threads,
                                error *e)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = ignore_message;
    init.user_data = file;
    init.write_fn = write_bytes;
    init.alloc_fn = core_allocate;
    init.free_fn = core_free;
    exr_context_t core = NULL;
    if (threads < 1) threads = 1;
    exr_result_t rv = exr_start_write(&core, name, EXR_WRITE_FILE_DIRECTLY, &init);
    if (rv == EXR_ERR_SUCCESS) rv = exrio_put_header(core, parts, part_count);
    for (int i = 0; rv == EXR_ERR_SUCCESS && i < part_count; i++) rv = write_part(core, i, &parts[i], threads, e);
    exr_result_t finished = core ? exr_finish(&core) : EXR_ERR_SUCCESS;
    if (rv == EXR_ERR_SUCCESS) rv = finished;
    return rv;
}

bool exrio_write(const char *path, const exrio_out_part *parts, int part_count, int threads, error *e)
{
    return exrio_write_inspected(path, parts, part_count, threads, NULL, e);
}

bool exrio_write_inspected(const char *path, const exrio_out_part *parts, int part_count, int threads,
                           const exrio_inspector *inspector, error *e)
{
    if (!exrio_check_parts(path, parts, part_count, e)) return false;
    outfile file = OUTFILE_NONE;
    if (!outfile_begin(path, &file, e)) return false;
    exr_result_t rv = write_parts(&file, file.temp, parts, part_count, threads, e);
    if (rv == EXR_ERR_SUCCESS && inspect(inspector, &file, e)) return outfile_commit(&file, e);
    if (rv != EXR_ERR_SUCCESS) report(rv, &file, path, e);
    outfile_abort(&file);
    return false;
}

int exrio_write_memory(const exrio_out_part *parts, int part_count, int threads, error *e)
{
    static const char name[] = "a file in memory";
    if (!exrio_check_parts(name, parts, part_count, e)) return -1;
    outfile file = {.fd = memfd_create("ssdo", MFD_CLOEXEC)};
    if (file.fd < 0) {
        err_set(e, ERR_MEMORY, NULL, NULL, "a file in memory cannot be made: %s", strerror(errno));
        return -1;
    }
    exr_result_t rv = write_parts(&file, name, parts, part_count, threads, e);
    if (rv == EXR_ERR_SUCCESS) return file.fd;
    report(rv, &file, name, e);
    close(file.fd);
    return -1;
}

bool exrio_part_is_verbatim(const exrio_part *part) { return !part->tiled; } // deep ones too, by their lines
