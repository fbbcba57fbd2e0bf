#include "exr/file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/infile.h"
#include "base/mem.h"
#include "exr/internal.h"

// --- the library's messages ---

static void keep_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)code;
    void *user = NULL;
    // Safe only for reading: a writing context would lock itself a second time here.
    if (!context || exr_get_user_data(context, &user) != EXR_ERR_SUCCESS || !user) return;
    core_log_keep(&((exrio_reader *)user)->log, message);
}

void core_log_keep(core_log *log, const char *message)
{
    pthread_mutex_lock(&log->lock);
    if (log->armed && !log->text[0]) {
        strncpy(log->text, message, sizeof log->text - 1);
        for (char *p = log->text; *p; p++)
            if (*p == '\n') *p = ' ';
    }
    pthread_mutex_unlock(&log->lock);
}

void core_log_arm(core_log *log)
{
    pthread_mutex_lock(&log->lock);
    memset(log->text, 0, sizeof log->text);
    log->refused = 0;
    log->armed = true;
    pthread_mutex_unlock(&log->lock);
}

bool core_log_report(core_log *log, exr_result_t code, error_code kind, const char *path, const char *what, error *e)
{
    pthread_mutex_lock(&log->lock);
    log->armed = false;
    const char *text = log->text[0] ? log->text : exr_get_default_error_message(code);
    if (code == EXR_ERR_OUT_OF_MEMORY)
        err_set(e, ERR_MEMORY, path, NULL, "out of memory; try fewer threads or frames in flight");
    else if (log->refused)
        err_set_system(e, kind, log->refused, path, "cannot be read");
    else
        err_set(e, kind, path, NULL, "%s (%s)", what, text);
    pthread_mutex_unlock(&log->lock);
    return false;
}

// --- opening ---

// The library reads a few bytes beyond a buffer's end in damaged PIZ blocks (fixed after 3.1.5): they are there, and zero.
enum { SLACK = 64 };

// The library's header parser passes over an attribute for which there was no memory and makes up a value for it, so we remember
// that it was refused some. It allocates on the thread that opens, and gives its allocator no context.
static _Thread_local bool starved;

static void *core_allocate(size_t size)
{
    void *p = size > SIZE_MAX - SLACK ? NULL : mem_zero(size + SLACK, 1, NULL);
    starved = starved || !p;
    return p;
}
static void core_free(void *p) { free(p); }

// The library (3.1.5) wants a version attribute of flat parts too once the file's flags say that some part is deep. Each part's
// type says it as well, so the flag of a multi-part file is kept from it.
static void hide_deep_flag(uint8_t *bytes, uint64_t got, uint64_t offset)
{
    enum { PLACE = 5, DEEP = 0x08, MULTIPART = 0x10 }; // of the version field's second byte
    if (offset <= PLACE && offset + got > PLACE && bytes[PLACE - offset] & MULTIPART) bytes[PLACE - offset] &= (uint8_t)~DEEP;
}

// The part of the tables that lies in [offset, offset + got).
static void put_restored(const exrio_reader *r, uint8_t *bytes, uint64_t got, uint64_t offset)
{
    uint64_t from = offset > r->tables ? offset : r->tables, end = r->tables + r->restored_size;
    uint64_t to = offset + got < end ? offset + got : end;
    if (from < to) memcpy(bytes + (from - offset), r->restored + (from - r->tables), to - from);
}

size_t exrio_read_bytes(exrio_reader *r, void *buffer, size_t size, uint64_t offset)
{
    size_t got = infile_read_at(r->fd, buffer, size, offset);
    int refused = errno;
    if (r->restored) put_restored(r, buffer, got, offset);
    if (refused) {
        pthread_mutex_lock(&r->log.lock);
        if (!r->log.refused) r->log.refused = refused;
        pthread_mutex_unlock(&r->log.lock);
    }
    errno = refused;
    return got;
}

static int64_t read_bytes(exr_const_context_t context, void *user, void *buffer, uint64_t size, uint64_t offset,
                          exr_stream_error_func_ptr_t report)
{
    size_t got = exrio_read_bytes(user, buffer, size, offset);
    int refused = errno;
    hide_deep_flag(buffer, got, offset);
    if (!refused) return (int64_t)got; // the library knows what it needs
    report(context, EXR_ERR_READ_IO, "%s", strerror(refused));
    return -1;
}

static int64_t file_size(exr_const_context_t context, void *user)
{
    (void)context;
    return (int64_t)((const exrio_reader *)user)->size;
}

static bool open_core(exrio_reader *r, error *e)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = keep_message;
    init.user_data = r;
    init.read_fn = read_bytes;
    init.size_fn = file_size;
    init.alloc_fn = core_allocate;
    init.free_fn = core_free;
    init.max_image_width = init.max_image_height = EXRIO_MAX_SIDE;
    init.max_tile_width = init.max_tile_height = EXRIO_MAX_SIDE;
    // A file whose chunk table is incomplete lost its end; guessing where the chunks are would hide that.
    init.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    core_log_arm(&r->log);
    exr_context_t core = NULL;
    starved = false;
    exr_result_t rv = exr_start_read(&core, r->file.path, &init);
    r->file.core = core;
    if (starved) rv = EXR_ERR_OUT_OF_MEMORY;
    if (rv != EXR_ERR_SUCCESS)
        return core_log_report(&r->log, rv, ERR_INPUT, r->file.path,
                               "has a header that cannot be used; render it or copy it again", e);
    return true;
}

static bool check_window(const exrio_file *file, const exrio_part *p, error *e)
{
    int64_t w = (int64_t)p->data_window.x1 - p->data_window.x0 + 1, h = (int64_t)p->data_window.y1 - p->data_window.y0 + 1;
    if (w >= 1 && h >= 1 && w <= EXRIO_MAX_SIDE && h <= EXRIO_MAX_SIDE && w * h <= EXRIO_MAX_PIXELS) return true;
    return err_set(e, ERR_INPUT, file->path, NULL,
                   "has a data window of %lld x %lld pixels, beyond what is read (%d on a side, %d in all); crop it",
                   (long long)w, (long long)h, EXRIO_MAX_SIDE, EXRIO_MAX_PIXELS);
}

// Of the compressions that the library has known for long; of a newer one, the most that any has.
static int32_t lines_per_chunk(int compression)
{
    switch (compression) {
    case EXR_COMPRESSION_NONE:
    case EXR_COMPRESSION_RLE:
    case EXR_COMPRESSION_ZIPS:
        return 1;
    case EXR_COMPRESSION_ZIP:
    case EXR_COMPRESSION_PXR24:
        return 16;
    case EXR_COMPRESSION_PIZ:
    case EXR_COMPRESSION_B44:
    case EXR_COMPRESSION_B44A:
    case EXR_COMPRESSION_DWAA:
        return 32;
    default:
        return 256;
    }
}

// The library computes with a chunk's size as an int.
static bool check_chunk_size(const exrio_file *file, int index, const exrio_part *p, error *e)
{
    uint64_t pixel = 0, w = (uint64_t)box2_width(p->data_window), h = (uint64_t)box2_height(p->data_window);
    for (int c = 0; c < p->channel_count; c++) pixel += sample_size(p->channels[c].type);
    uint64_t columns = w;
    int32_t lines = 1;
    uint32_t tx, ty;
    exr_tile_level_mode_t level;
    exr_tile_round_mode_t round;
    if (p->tiled) {
        if (exr_get_tile_descriptor(file->core, index, &tx, &ty, &level, &round) != EXR_ERR_SUCCESS)
            return err_set(e, ERR_INPUT, file->path, NULL, "is damaged: it is tiled but does not say how; render it again");
        lines = ty > INT32_MAX ? INT32_MAX : (int32_t)ty;
        if (tx < columns) columns = tx;
    } else if (exr_get_scanlines_per_chunk(file->core, index, &lines) != EXR_ERR_SUCCESS || lines < 1) {
        lines = lines_per_chunk(p->compression); // the library has no answer for lines with a leftover of tiles in the header
    }
    if ((uint64_t)lines < h) h = (uint64_t)lines;
    if (pixel * h * columns <= EXRIO_MAX_CHUNK_BYTES) return true;
    return err_set(e, ERR_INPUT, file->path, NULL,
                   "has blocks of more than %d bytes; save it again with ZIP compression or smaller tiles",
                   EXRIO_MAX_CHUNK_BYTES);
}

static bool fill_channels(exrio_file *file, int index, exrio_part *p, error *e)
{
    const exr_attr_chlist_t *list = NULL;
    if (exr_get_channels(file->core, index, &list) != EXR_ERR_SUCCESS || list->num_channels < 1)
        return err_set(e, ERR_INPUT, file->path, NULL, "is damaged: a part has no channels; render it again");
    p->channels = mem_zero((size_t)list->num_channels, sizeof *p->channels, e);
    if (!p->channels) return false;
    for (int c = 0; c < list->num_channels; c++) {
        const exr_attr_chlist_entry_t *entry = &list->entries[c];
        if (entry->x_sampling != 1 || entry->y_sampling != 1)
            return err_set(e, ERR_INPUT, file->path, entry->name.str,
                           "holds a subsampled channel, which is not supported; resample it to full size first");
        if ((unsigned)entry->pixel_type >= EXR_PIXEL_LAST_TYPE)
            return err_set(e, ERR_INPUT, file->path, entry->name.str, "is damaged: unknown pixel type; render it again");
        p->channels[c].type = (sample_type)entry->pixel_type;
        p->channels[c].name = mem_string(entry->name.str, e);
        if (!p->channels[c].name) return false;
        p->channel_count = c + 1;
    }
    return true;
}

static box2 box_from(exr_attr_box2i_t b) { return (box2){b.min.x, b.min.y, b.max.x, b.max.y}; }

static bool fill_part(exrio_file *file, int index, error *e)
{
    exrio_part *p = &file->parts[index];
    exr_storage_t storage;
    exr_attr_box2i_t data, display;
    exr_compression_t compression;
    if (exr_get_storage(file->core, index, &storage) != EXR_ERR_SUCCESS ||
        exr_get_data_window(file->core, index, &data) != EXR_ERR_SUCCESS ||
        exr_get_display_window(file->core, index, &display) != EXR_ERR_SUCCESS ||
        exr_get_compression(file->core, index, &compression) != EXR_ERR_SUCCESS)
        return err_set(e, ERR_INPUT, file->path, NULL, "is damaged: part %d lacks a required attribute; render it again", index);
    p->tiled = storage == EXR_STORAGE_TILED || storage == EXR_STORAGE_DEEP_TILED;
    p->deep = storage == EXR_STORAGE_DEEP_SCANLINE || storage == EXR_STORAGE_DEEP_TILED;
    p->data_window = box_from(data);
    p->display_window = box_from(display);
    p->compression = (int)compression;
    if (exr_get_pixel_aspect_ratio(file->core, index, &p->pixel_aspect) != EXR_ERR_SUCCESS) p->pixel_aspect = 1.0f;
    const char *name = NULL, *view = NULL;
    if (exr_get_name(file->core, index, &name) != EXR_ERR_SUCCESS || !name) name = "";
    if (!exrio_attr_string(file, index, "view", &view)) view = "";
    p->name = mem_string(name, e);
    p->view = mem_string(view, e);
    return p->name && p->view && check_window(file, p, e) && fill_channels(file, index, p, e) &&
           (p->deep || check_chunk_size(file, index, p, e)) && exrio_fill_views(file, index, p, e);
}

bool exrio_file_open(const char *path, exrio_file **out, error *e)
{
    *out = NULL;
    exrio_reader *r = mem_zero(1, sizeof *r, e);
    if (!r) return false;
    pthread_mutex_init(&r->log.lock, NULL);
    exrio_file *file = &r->file;
    int count = 0;
    r->fd = infile_open(path, (infile_kind){NULL, ERR_INPUT}, &r->size, e);
    file->path = mem_string(path, e);
    if (r->fd < 0 || !file->path || !exrio_check_header(path, r->fd, r->size, &r->tables, e) || !open_core(r, e)) goto fail;
    exr_get_count(file->core, &count);
    file->parts = mem_zero((size_t)count, sizeof *file->parts, e);
    if (!file->parts) goto fail;
    file->part_count = count;
    for (int i = 0; i < count; i++)
        if (!fill_part(file, i, e)) goto fail;
    if (!exrio_restore_tables(r, e)) goto fail;
    r->log.armed = false;
    *out = file;
    return true;

fail:
    if (e && e->code != ERR_NONE && !e->file[0]) strncpy(e->file, path, sizeof e->file - 1); // out of memory knows no file
    exrio_file_close(file);
    return false;
}

void exrio_file_close(exrio_file *file)
{
    if (!file) return;
    if (file->members) {
        exrio_merged_close(file);
        return;
    }
    for (int i = 0; i < file->part_count; i++) {
        exrio_part *p = &file->parts[i];
        for (int c = 0; p->channels && c < p->channel_count; c++) {
            free(p->channels[c].name);
            free(p->channels[c].stored);
            free(p->channels[c].data);
        }
        free(p->channels);
        free(p->name);
        free(p->view);
        exrio_free_views(p);
    }
    free(file->parts);
    free(file->path);
    free(((exrio_reader *)file)->restored);
    exr_context_t core = file->core;
    if (core) exr_finish(&core);
    exrio_reader *r = (exrio_reader *)file;
    if (r->fd >= 0) close(r->fd);
    pthread_mutex_destroy(&r->log.lock);
    free(r);
}
