#include "pipeline/read_back.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/mem.h"
#include "base/threads.h"
#include "exr/write.h"
#include "gpu/transfer.h"

enum {
    PIECE = 1 << 15, // floats that one thread converts at a time: they stay in its cache
    GROUP = 4,       // pieces for each thread that are fetched together, where nothing is mapped
};

// Rows of a layer as the device holds them, in one image or, for sh_3, in two.
struct layer_band {
    layer_id layer;
    int y, rows;
    size_t stored; // floats a pixel in each image
    const float *v[2];
    gpu_transfer down[2];
};
typedef struct layer_band band;

// Memory that all layers of a frame use in turn.
typedef struct scratch_memory {
    float *v;
    size_t size;
} scratch_memory;

// The rows as they come, where nothing is mapped, and each thread's piece.
typedef struct workspace {
    scratch_memory rows, scratch;
} workspace;

static bool provide(scratch_memory *m, size_t size, error *e)
{
    if (m->size >= size) return true;
    free(m->v);
    m->v = mem_pixels(size, sizeof *m->v, e);
    m->size = m->v ? size : 0;
    return m->v != NULL;
}

static void free_workspace(workspace *w)
{
    free(w->rows.v);
    free(w->scratch.v);
}

static size_t channels_of(layer_id l) { return strlen(layer_table[l]->channels); }
static int images_of(layer_id l) { return channels_of(l) > 4 ? 2 : 1; }

// ---- conversion

// A layer never holds NaN or infinity, whatever happened before, and keeps its range.
static inline float sane(float v, bool share, bool light)
{
    if (!(fabsf(v) <= 3e38f)) v = share ? 1.0f : isnan(v) ? 0.0f : copysignf(3e38f, v);
    if (share) return v < 0.0f ? 0.0f : v > 1.0f ? 1.0f : v;
    return light && v < 0.0f ? 0.0f : v;
}

// One channel of every `stride` floats.
static void sanitise(layer_id l, const float *v, size_t stride, size_t pixels, float *to)
{
    bool share = layer_table[l]->range == RANGE_SHARE, light = layer_table[l]->range == RANGE_LIGHT;
    for (size_t i = 0; i < pixels; i++) to[i] = sane(v[i * stride], share, light);
}

// Bent normals: unit length, in the space of the file's normals. Where nothing is open the normal stands in.
static void point_along(const gbuffer *gb, size_t first, float *v, size_t pixels)
{
    float *x = v, *y = v + pixels, *z = y + pixels;
    for (size_t i = 0; i < pixels; i++) {
        const float *n = gb->normal + 4 * (first + i);
        vec3 d = v3((double)x[i], (double)y[i], (double)z[i]);
        if (v3_length(d) < 1e-4) d = v3((double)n[0], (double)n[1], (double)n[2]);
        d = v3_normalize(m3_apply(gb->normal_from_camera, d));
        x[i] = (float)d.x, y[i] = (float)d.y, z[i] = (float)d.z;
    }
}

static size_t put(const float *v, size_t n, sample_type type, void *to, size_t first)
{
    if (type == SAMPLE_HALF) return exrio_to_half(v, 1, n, (uint16_t *)to + first);
    memcpy((float *)to + first, v, n * sizeof *v);
    return 0;
}

// A picture that stands beside a float beauty keeps its precision, so that an untouched beauty comes back bit for bit.
static sample_type type_of(const job *j, const frame_result *r, layer_id l)
{
    if (j->o->output_float) return SAMPLE_FLOAT;
    channel_ref beauty = r->resolution.channels[ROLE_BEAUTY][0];
    if (l == LAYER_COMPOSITE && !r->plan.relight && r->resolution.components[ROLE_BEAUTY] > 0)
        return r->file->parts[beauty.part].channels[beauty.channel].type;
    return SAMPLE_HALF;
}

static bool make_samples(const job *j, layer_id l, frame_result *r, error *e)
{
    size_t pixels = (size_t)r->gb.width * (size_t)r->gb.height, channels = channels_of(l);
    r->types[l] = type_of(j, r, l);
    for (size_t k = 0; k < channels; k++)
        if (!r->samples[l][k] && !(r->samples[l][k] = mem_pixels(pixels, sample_size(r->types[l]), e))) return false;
    return j->no_floats || r->layers[l] || (r->layers[l] = mem_pixels(pixels * channels, sizeof(float), e));
}

typedef struct conversion {
    frame_result *r;
    const band *b;
    int rows;       // of a piece
    float *scratch; // a piece's channels, one after the other, for each thread
    atomic_size_t clamped;
} conversion;

static size_t scratch_size(const conversion *c) { return channels_of(c->b->layer) * (size_t)c->rows * (size_t)c->r->gb.width; }

static bool convert_piece(void *context, size_t item, int worker)
{
    conversion *c = context;
    const band *b = c->b;
    frame_result *r = c->r;
    layer_id l = b->layer;
    int y = (int)item * c->rows, rows = b->rows - y < c->rows ? b->rows - y : c->rows;
    size_t width = (size_t)r->gb.width, pixels = (size_t)rows * width, from = (size_t)y * width,
           first = from + (size_t)b->y * width;
    size_t channels = channels_of(l), clamped = 0;
    float *v = c->scratch + (size_t)worker * scratch_size(c);
    for (size_t k = 0; k < channels; k++) sanitise(l, b->v[k / 4] + from * b->stored + k % 4, b->stored, pixels, v + k * pixels);
    if (layer_table[l]->range == RANGE_DIRECTION) point_along(&r->gb, first, v, pixels);
    for (size_t k = 0; k < channels; k++) {
        float *floats = r->layers[l] ? r->layers[l] + channels * first + k : NULL;
        for (size_t i = 0; floats && i < pixels; i++) floats[i * channels] = v[k * pixels + i];
        clamped += put(v + k * pixels, pixels, r->types[l], r->samples[l][k], first);
    }
    atomic_fetch_add(&c->clamped, clamped);
    return true;
}

static int piece_rows(const frame_result *r, size_t stored)
{
    size_t rows = PIECE / (stored * (size_t)r->gb.width);
    return rows > 1 ? (int)rows : 1;
}

static bool convert_band(const job *j, frame_result *r, const band *b, workspace *w, error *e)
{
    stopwatch t = stopwatch_start();
    conversion c = {.r = r, .b = b, .rows = piece_rows(r, b->stored)};
    size_t pieces = (size_t)(b->rows + c.rows - 1) / (size_t)c.rows;
    size_t threads = pieces < (size_t)j->threads ? pieces : (size_t)j->threads;
    if (!make_samples(j, b->layer, r, e) || !provide(&w->scratch, threads * scratch_size(&c), e)) return false;
    c.scratch = w->scratch.v;
    threads_for((int)threads, pieces, convert_piece, &c);
    r->clamped += c.clamped;
    stopwatch_add(&t, &r->wall_ms[STAGE_CONVERT], &r->cpu_ms[STAGE_CONVERT]);
    return true;
}

// ---- fetching

static size_t components(const gpu_image *image) { return image->format == GL_R32F ? 1 : 4; }

// Rows at a time through memory of ours, converted while they are in the cache.
static bool fetch_directly(job *j, const gpu_image *image, layer_id l, frame_result *r, workspace *w, error *e)
{
    band b = {.layer = l, .stored = components(image)};
    int images = images_of(l), most = piece_rows(r, b.stored) * GROUP * j->threads;
    if (most > r->gb.height) most = r->gb.height;
    size_t size = b.stored * (size_t)r->gb.width * (size_t)most;
    bool ok = provide(&w->rows, (size_t)images * size, e);
    for (; ok && b.y < r->gb.height; b.y += b.rows) {
        b.rows = r->gb.height - b.y < most ? r->gb.height - b.y : most;
        for (int i = 0; i < images; i++) {
            float *v = w->rows.v + (size_t)i * size;
            gpu_image_download_rows(&j->g, image + i, b.y, b.rows, v);
            b.v[i] = v;
        }
        ok = convert_band(j, r, &b, w, e);
    }
    return ok;
}

static bool start_band(gpu *g, const gpu_image *image, layer_id l, int y, int rows, frame_result *r)
{
    error none = {0};
    band *grown = mem_grow(r->bands, (size_t)r->band_count + 1, sizeof *grown, &none);
    if (!grown) return false;
    r->bands = grown;
    band *b = &r->bands[r->band_count++];
    *b = (band){.layer = l, .y = y, .rows = rows, .stored = components(image)};
    for (int i = 0; i < images_of(l); i++) {
        if (!gpu_transfer_start(g, image + i, y, rows, &b->down[i], &none)) return false;
        b->v[i] = b->down[i].pixels;
    }
    return true;
}

static void drop_bands(frame_result *r, int keep)
{
    for (; r->band_count > keep; r->band_count--)
        for (int i = 0; i < 2; i++) gpu_transfer_end(&r->bands[r->band_count - 1].down[i]);
}

// False if there is no room for the buffers; then nothing of the layer is under way.
static bool start_layer(gpu *g, const gpu_image *image, layer_id l, frame_result *r)
{
    int before = r->band_count, most = gpu_transfer_rows(g, image);
    for (int y = 0, rows; y < r->gb.height; y += rows) {
        rows = r->gb.height - y < most ? r->gb.height - y : most;
        if (start_band(g, image, l, y, rows, r)) continue;
        drop_bands(r, before);
        return false;
    }
    return true;
}

// The first, of a layer in two.
static const gpu_image *image_of(const pass_context *c, layer_id l)
{
    const image_row *row = layer_table[l];
    bool missing = c->image[row->image].id == 0 && row->otherwise != IMAGE_DEPTH;
    return &c->image[missing ? row->otherwise : row->image];
}

bool read_back_begin(job *j, const pass_context *c, frame_result *r, error *e)
{
    workspace w = {0};
    bool ok = true;
    for (int i = 0; ok && i < LAYER_COUNT; i++) {
        layer_id l = (layer_id)i;
        const gpu_image *image = image_of(c, l);
        if (!(r->plan.layers & 1u << l) || (j->g.mapped && start_layer(&j->g, image, l, r))) continue;
        ok = fetch_directly(j, image, l, r, &w, e);
    }
    free_workspace(&w);
    return ok && gpu_check(&j->g, "the read-back", e);
}

bool read_back_wait(job *j, const frame_result *r, error *e)
{
    for (int i = 0; i < 2 * r->band_count; i++)
        if (!gpu_transfer_wait(&j->g, &r->bands[i / 2].down[i % 2], e)) return false;
    return true;
}

static bool convert_all(const job *j, gpu *waiting, frame_result *r, error *e)
{
    workspace w = {0};
    bool ok = true;
    for (int i = 0; ok && i < r->band_count; i++) {
        band *b = &r->bands[i];
        stopwatch t = stopwatch_start();
        for (int k = 0; ok && waiting && k < 2; k++) ok = gpu_transfer_wait(waiting, &b->down[k], e);
        if (waiting) stopwatch_add(&t, &r->wall_ms[STAGE_READ_BACK], &r->cpu_ms[STAGE_READ_BACK]);
        ok = ok && convert_band(j, r, b, &w, e);
        for (int k = 0; k < 2; k++) gpu_transfer_end(&b->down[k]);
    }
    free_workspace(&w);
    read_back_drop(r);
    return ok;
}

bool read_back_convert(const job *j, frame_result *r, error *e) { return convert_all(j, NULL, r, e); }
bool read_back_finish(job *j, frame_result *r, error *e) { return convert_all(j, &j->g, r, e); }

void read_back_drop(frame_result *r)
{
    drop_bands(r, 0);
    free(r->bands);
    r->bands = NULL;
}
