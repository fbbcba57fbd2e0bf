#include <stdlib.h>

#include "../shaders/include/constants.glsl"
#include "base/knobs.h"
#include "base/mem.h"
#include "gpu/gpu.h"

// On hardware a tile of 512 pixels a side at up to 256 samples a pixel, half of that at four times as many: by
// estimate the march of such a tile takes 3 ms on a GPU of a data centre, so one fifteen times as slow stays below 50 ms.
static int hardware_size(int samples)
{
    enum { LARGEST = 512, SAMPLES = 256 };
    int size = LARGEST;
    for (; size > GPU_TILE && samples > SAMPLES; samples /= 4) size /= 2;
    return size;
}

int gpu_tile_size(const gpu *g, int samples)
{
    const char *s = knob_value("SSDO_TILE");
    int size = s ? atoi(s) : 0;
    if (size > 0 && size <= 65536) return size;
    return g->software ? GPU_TILE : hardware_size(samples);
}

// What says where surfaces are: bytes, or floats.
typedef struct surfaces {
    const unsigned char *bytes;
    const float *mask, *coverage;
} surfaces;

static bool any(const surfaces *s, size_t first, int n)
{
    for (size_t i = first; i < first + (size_t)n; i++)
        if (s->bytes ? s->bytes[i] != 0 : s->mask[i] != 0.0f || (s->coverage && s->coverage[i] > 0.0f)) return true;
    return false;
}

static bool make(gpu_tiles *t, int width, int height, int size, const surfaces *s, error *e)
{
    *t = (gpu_tiles){.width = width, .height = height, .size = size};
    t->columns = (width + size - 1) / size;
    t->rows = (height + size - 1) / size;
    t->occupied = mem_zero((size_t)t->columns * (size_t)t->rows, 1, e);
    if (!t->occupied) return false;
    for (int y = 0; y < height; y++)
        for (int column = 0; column < t->columns; column++) {
            int x = column * size, n = x + size < width ? size : width - x;
            unsigned char *occupied = &t->occupied[y / size * t->columns + column];
            if (!*occupied) *occupied = any(s, (size_t)y * (size_t)width + (size_t)x, n);
        }
    for (int i = 0; i < t->columns * t->rows; i++) t->occupied_count += t->occupied[i];
    return true;
}

bool gpu_tiles_of(gpu_tiles *t, int width, int height, int size, const unsigned char *mask, error *e)
{
    return make(t, width, height, size, &(surfaces){.bytes = mask}, e);
}

bool gpu_tiles_make(gpu_tiles *t, int width, int height, int size, const float *mask, const float *coverage, error *e)
{
    return make(t, width, height, size, &(surfaces){.mask = mask, .coverage = coverage}, e);
}

void gpu_tiles_free(gpu_tiles *t)
{
    free(t->occupied);
    *t = (gpu_tiles){0};
}

gpu_counts gpu_counts_since(const gpu *g, const gpu_counts *before)
{
    const gpu_counts *c = &g->counts;
    return (gpu_counts){
        .dispatches = c->dispatches - before->dispatches,
        .draws = c->draws - before->draws,
        .barriers = c->barriers - before->barriers,
        .uploads = c->uploads - before->uploads,
        .read_backs = c->read_backs - before->read_backs,
        .bytes_up = c->bytes_up - before->bytes_up,
        .bytes_down = c->bytes_down - before->bytes_down,
    };
}

void gpu_dispatch(gpu *g, unsigned x, unsigned y, unsigned z)
{
    glDispatchCompute(x, y, z);
    g->counts.dispatches++;
}

void gpu_barrier(gpu *g, GLbitfield bits)
{
    glMemoryBarrier(bits);
    g->counts.barriers++;
}

void gpu_dispatch_tiles(gpu *g, const gpu_tiles *t, bool everywhere)
{
    for (int row = 0; row < t->rows; row++)
        for (int column = 0; column < t->columns; column++) {
            if (!everywhere && !t->occupied[row * t->columns + column]) continue;
            if (t->stop && *t->stop) return; // the frame will be dropped
            int x0 = column * t->size, y0 = row * t->size;
            int x1 = x0 + t->size < t->width ? x0 + t->size : t->width, y1 = y0 + t->size < t->height ? y0 + t->size : t->height;
            glUniform4i(0, x0, y0, x1, y1);
            gpu_dispatch(g, (GLuint)(x1 - x0 + GROUP_SIDE - 1) / GROUP_SIDE, (GLuint)(y1 - y0 + GROUP_SIDE - 1) / GROUP_SIDE, 1);
        }
    gpu_barrier(g, GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT |
                       GL_FRAMEBUFFER_BARRIER_BIT);
}

void gpu_dispatch_groups(gpu *g, int columns, int rows, int first, int end)
{
    if (end > first) glUniform4i(0, first, end, 0, 0);
    gpu_dispatch(g, (GLuint)columns, (GLuint)(rows > 0 ? rows : 1), 1);
    gpu_barrier(g, GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                       GL_TEXTURE_UPDATE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT);
}

// Tiles side by side go into one draw, but not many: one draw should stay short.
static int run_length(const gpu_tiles *t, int row, int column, bool everywhere)
{
    enum { LONGEST = 8 };
    int n = 0;
    while (n < LONGEST && column + n < t->columns && (everywhere || t->occupied[row * t->columns + column + n])) n++;
    return n;
}

static void attach(gpu *g, const gpu_image *const targets[], int count)
{
    GLenum buffers[GPU_MAX_TARGETS] = {GL_NONE};
    if (!g->framebuffer) glCreateFramebuffers(1, &g->framebuffer);
    if (!g->vertex_array) glCreateVertexArrays(1, &g->vertex_array);
    for (int i = 0; i < GPU_MAX_TARGETS; i++) {
        GLuint id = i < count && targets[i] ? targets[i]->id : 0;
        glNamedFramebufferTexture(g->framebuffer, GL_COLOR_ATTACHMENT0 + (GLenum)i, id, 0);
        buffers[i] = id ? GL_COLOR_ATTACHMENT0 + (GLenum)i : GL_NONE;
    }
    glNamedFramebufferDrawBuffers(g->framebuffer, count, buffers);
    glBindFramebuffer(GL_FRAMEBUFFER, g->framebuffer);
    glBindVertexArray(g->vertex_array);
}

void gpu_draw_tiles(gpu *g, const gpu_tiles *t, bool everywhere, const gpu_image *const targets[], int target_count)
{
    attach(g, targets, target_count);
    glViewport(0, 0, t->width, t->height);
    glDisable(GL_DITHER);
    glEnable(GL_SCISSOR_TEST);
    for (int row = 0; row < t->rows; row++)
        for (int column = 0; column < t->columns; column++) {
            int n = run_length(t, row, column, everywhere);
            if (n == 0) continue;
            if (t->stop && *t->stop) break;                                   // the frame will be dropped
            glScissor(column * t->size, row * t->size, n * t->size, t->size); // beyond the picture nothing is drawn
            glDrawArrays(GL_TRIANGLES, 0, 3);
            g->counts.draws++;
            column += n - 1;
        }
    glDisable(GL_SCISSOR_TEST); // clears would obey it
    for (int i = 0; i < target_count; i++) glNamedFramebufferTexture(g->framebuffer, GL_COLOR_ATTACHMENT0 + (GLenum)i, 0, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}
