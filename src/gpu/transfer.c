#include "gpu/transfer.h"

#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/threads.h"
#include "gpu/internal.h"

enum { MIB = 1 << 20, UP_BYTES = 32 * MIB, COPY_BYTES = MIB };

struct gpu_pixel_buffer {
    gpu_pixel_buffer *next;
    GLuint id;
    size_t size;
    void *mapped;
    GLsync fence;      // behind the last command that uses the buffer; the GL thread's own
    atomic_bool taken; // on the way down: its pixels are not read yet
};

static gpu_pixel_buffer *make(size_t size, GLbitfield access, error *e)
{
    gpu_pixel_buffer *b = mem_zero(1, sizeof *b, e);
    if (!b) return NULL;
    b->size = size;
    access |= GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    GLbitfield where = access & GL_MAP_READ_BIT ? GL_CLIENT_STORAGE_BIT : 0; // memory that the CPU reads fast
    glCreateBuffers(1, &b->id);
    glNamedBufferStorage(b->id, (GLsizeiptr)size, NULL, access | where);
    b->mapped = glMapNamedBufferRange(b->id, 0, (GLsizeiptr)size, access);
    GLenum code = glGetError();
    if (b->mapped && code == GL_NO_ERROR) return b;
    glDeleteBuffers(1, &b->id);
    free(b);
    err_set(e, ERR_MEMORY, NULL, NULL, "the GL device has no room for a transfer buffer of %zu MB (GL error 0x%04x)", size >> 20,
            code);
    return NULL;
}

static void destroy(gpu_pixel_buffer *b)
{
    if (!b) return;
    if (b->fence) glDeleteSync(b->fence);
    glDeleteBuffers(1, &b->id); // unmaps it
    free(b);
}

void gpu_transfers_free(gpu *g)
{
    for (gpu_pixel_buffer *b = g->down, *next; b; b = next) {
        next = b->next;
        destroy(b);
    }
    for (int i = 0; i < GPU_UP_BUFFERS; i++) destroy(g->up[i]);
}

static void put_fence(gpu_pixel_buffer *b)
{
    if (b->fence) glDeleteSync(b->fence);
    b->fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
}

static bool pass_fence(gpu *g, const gpu_pixel_buffer *b, error *e)
{
    const GLuint64 second = 1000000000u;
    if (!b->fence) return true;
    GLenum state;
    do {
        state = glClientWaitSync(b->fence, GL_SYNC_FLUSH_COMMANDS_BIT, second);
        if (g->robust && glGetGraphicsResetStatus() != GL_NO_ERROR) state = GL_WAIT_FAILED;
    } while (state == GL_TIMEOUT_EXPIRED);
    return state != GL_WAIT_FAILED ||
           err_set(e, ERR_GL, NULL, NULL, "the GL context was lost during a transfer; run the frame again");
}

// ---- down

// The smallest free buffer that is large enough. Those that are free and too small are of another sequence's frames.
static gpu_pixel_buffer *find_free(gpu *g, size_t size)
{
    gpu_pixel_buffer *best = NULL;
    for (gpu_pixel_buffer *b = g->down; b; b = b->next)
        if (!atomic_load(&b->taken) && b->size >= size && (!best || b->size < best->size)) best = b;
    for (gpu_pixel_buffer **link = &g->down, *b; !best && (b = *link);) {
        if (atomic_load(&b->taken)) {
            link = &b->next;
            continue;
        }
        *link = b->next;
        destroy(b);
    }
    return best;
}

int gpu_transfer_rows(const gpu *g, const gpu_image *image)
{
    size_t rows = g->band_bytes / gpu_image_row_bytes(image);
    return rows < 1 ? 1 : rows > INT32_MAX ? INT32_MAX : (int)rows;
}

bool gpu_transfer_start(gpu *g, const gpu_image *image, int y, int rows, gpu_transfer *t, error *e)
{
    size_t size = (size_t)rows * gpu_image_row_bytes(image);
    gpu_pixel_buffer *b = find_free(g, size);
    *t = (gpu_transfer){0};
    if (!b) {
        b = make(size, GL_MAP_READ_BIT, e);
        if (!b) return false;
        b->next = g->down;
        g->down = b;
    }
    atomic_store(&b->taken, true);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, b->id);
    gpu_image_download_rows(g, image, y, rows, NULL);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    put_fence(b);
    glFlush(); // the device begins now, not when somebody waits
    *t = (gpu_transfer){b, b->mapped};
    return true;
}

bool gpu_transfer_wait(gpu *g, const gpu_transfer *t, error *e) { return !t->buffer || pass_fence(g, t->buffer, e); }

void gpu_transfer_end(gpu_transfer *t)
{
    if (t->buffer) atomic_store(&t->buffer->taken, false);
    *t = (gpu_transfer){0};
}

// ---- up

typedef struct copy {
    char *to;
    const char *from;
    size_t size;
} copy;

static bool copy_piece(void *context, size_t item, int worker)
{
    const copy *c = context;
    size_t first = item * COPY_BYTES, n = c->size - first < COPY_BYTES ? c->size - first : COPY_BYTES;
    (void)worker;
    memcpy(c->to + first, c->from + first, n);
    return true;
}

static gpu_pixel_buffer *next_up(gpu *g, size_t size, error *e)
{
    gpu_pixel_buffer **b = &g->up[g->next_up];
    g->next_up = (g->next_up + 1) % GPU_UP_BUFFERS;
    if (*b && (*b)->size < size) {
        destroy(*b);
        *b = NULL;
    }
    if (!*b) *b = make(size, GL_MAP_WRITE_BIT, e);
    return *b;
}

bool gpu_image_send(gpu *g, gpu_image *image, const float *pixels, error *e)
{
    size_t row = gpu_image_row_bytes(image), whole = row * (size_t)image->height;
    size_t band = g->band_bytes < UP_BYTES ? g->band_bytes : UP_BYTES;
    int most = band > row ? (int)(band / row) : 1;
    size_t size = (size_t)most * row < whole ? (size_t)most * row : whole;
    for (int y = 0; y < image->height; y += most) {
        error none = {0};
        gpu_pixel_buffer *b = g->mapped ? next_up(g, size, &none) : NULL;
        if (!b) { // without a buffer the driver makes its own copy
            gpu_image_upload_rows(g, image, y, image->height - y, pixels + (size_t)y * (row / sizeof *pixels));
            return true;
        }
        int rows = image->height - y < most ? image->height - y : most;
        copy c = {b->mapped, (const char *)pixels + (size_t)y * row, (size_t)rows * row};
        if (!pass_fence(g, b, e)) return false;
        threads_for(g->threads, (c.size + COPY_BYTES - 1) / COPY_BYTES, copy_piece, &c);
        glBindBuffer(GL_PIXEL_UNPACK_BUFFER, b->id);
        gpu_image_upload_rows(g, image, y, rows, NULL);
        glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
        put_fence(b);
    }
    return true;
}
