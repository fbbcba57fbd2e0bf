#include "passes/pass.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "gpu/transfer.h"
#include "passes/params.h"
#include "passes/variants.h"

static void fill_block(frame_block *b, const gbuffer *gb, const environment *env, mat3 world_from_camera)
{
    const camera *cam = &gb->camera;
    *b = (frame_block){
        .lens = {(float)cam->fx, (float)cam->fy, (float)cam->cx, (float)cam->cy},
        .size = {gb->width, gb->height},
    };
    if (!env) return;
    mat3 m = m3_mul(env->map_from_world, world_from_camera);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) b->map_from_camera[r][c] = (float)m.m[r][c];
    const env_level *top = &env->levels[0];
    b->env[0] = (float)(env->level_count - 1);
    b->env[1] = (float)top->width;
    b->env[2] = (float)top->height;
    b->env[3] = env->white;
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++) b->sh[i][c] = (float)env->sh[i][c];
}

const float *pass_pixels(const gbuffer *gb, image_id id)
{
    const float *pixels;
    memcpy(&pixels, (const char *)gb + image_table[id].pixels, sizeof pixels);
    return pixels;
}

static bool upload(pass_context *c, image_id id, const float *pixels, error *e)
{
    const image_row *row = &image_table[id];
    gpu_image *image = &c->image[id];
    if (!gpu_image_make(c->g, image, row->format, c->width, c->height, 1, e) || !gpu_image_send(c->g, image, pixels, e))
        return false;
    c->uploads[c->upload_count++] = (pass_upload){row->name, gpu_image_row_bytes(image) * (size_t)c->height};
    return true;
}

static bool upload_all(pass_context *c, error *e)
{
    for (int i = 0; i < IMAGE_COUNT; i++) {
        const float *pixels = image_table[i].given ? pass_pixels(c->gb, (image_id)i) : NULL;
        if (pixels && !upload(c, (image_id)i, pixels, e)) return false;
    }
    return true;
}

bool pass_upload_environment(gpu *g, const environment *env, gpu_image *out, error *e)
{
    *out = (gpu_image){0};
    if (env->white) return true; // shaders take its radiance from the frame's block (frame.env.w)
    if (!gpu_image_make(g, out, GL_RGBA32F, env->levels[0].width, env->levels[0].height, env->level_count, e)) return false;
    for (int i = 0; i < env->level_count; i++) gpu_image_upload(g, out, i, env->levels[i].rgba);
    return gpu_finish(g, "the upload of the environment", e);
}

bool pass_begin(pass_context *c, error *e)
{
    double wall = clock_wall_ms(), cpu = clock_cpu_ms();
    c->width = c->gb->width, c->height = c->gb->height;
    bool ok =
        upload_all(c, e) &&
        gpu_tiles_make(&c->tiles, c->width, c->height, gpu_tile_size(c->g, c->set.samples), c->gb->depth, c->gb->coverage, e) &&
        gpu_finish(c->g, "the upload", e);
    if (!ok) {
        pass_end(c);
        return false;
    }
    frame_block block;
    fill_block(&block, c->gb, c->env, c->set.world_from_camera);
    c->frame_uniforms = gpu_uniforms_make(sizeof block);
    gpu_uniforms_set(c->frame_uniforms, FRAME_BINDING, &block, sizeof block);
    c->params_uniforms = gpu_uniforms_make(PARAMS_LARGEST);
    c->timings[c->timing_count++] = (pass_timing){"upload", clock_wall_ms() - wall, clock_cpu_ms() - cpu, 0};
    return true;
}

pass_context pass_like(const pass_context *c, const gbuffer *gb, const pass_settings *set)
{
    pass_context like = {
        .g = c->g,
        .log = c->log,
        .timing = c->timing,
        .threads = c->threads,
        .stop = c->stop,
        .set = *set,
        .want_diffuse = c->want_diffuse,
        .gb = gb,
        .env = c->env,
        .environment = c->environment,
        .views = c->views,
        .view_count = c->view_count,
        .further = c->further,
        .proxies = c->proxies,
        .surround = c->surround,
        .sunless = c->sunless,
        .trace = c->trace,
    };
    memcpy(like.relight_sh, c->relight_sh, sizeof like.relight_sh);
    return like;
}

void pass_take_timings(pass_context *c, const pass_context *from)
{
    for (int i = 0; i < from->timing_count && c->timing_count < PASS_MAX_TIMINGS; i++)
        c->timings[c->timing_count++] = from->timings[i];
}

void pass_end(pass_context *c)
{
    for (int i = 0; i < IMAGE_COUNT; i++) gpu_image_free(&c->image[i]);
    gpu_uniforms_free(c->frame_uniforms);
    gpu_uniforms_free(c->params_uniforms);
    gpu_tiles_free(&c->tiles);
    gpu_tiles_free(&c->adaptive.tiles);
    free(c->adaptive.last);
    c->adaptive.last = NULL;
    c->frame_uniforms = c->params_uniforms = 0;
}

bool pass_make_image(pass_context *c, image_id id, error *e)
{
    return pass_make(c, &c->image[id], image_table[id].format, image_table[id].neutral, e);
}

bool pass_add_group(const pass_context *c, unsigned group, variant *words, pass_picture writes[PASS_MOST_WRITES + 1])
{
    int count = 0;
    while (writes[count].name) count++;
    bool any = false;
    for (int i = 0; i < IMAGE_COUNT; i++) {
        const image_row *row = &image_table[i];
        if (!(row->groups & group) || !c->image[i].id) continue;
        any = true;
        variant_add(words, row->word != NULL, row->word);
        writes[count++] = (pass_picture){row->slot, &c->image[i]};
    }
    return any;
}

bool pass_make(pass_context *c, gpu_image *image, GLenum format, float value, error *e)
{
    if (image->id) return true;
    if (!gpu_image_make(c->g, image, format, c->width, c->height, 1, e)) return false;
    gpu_image_clear(image, (float[4]){value, value, value, value});
    return true;
}

pass_timing pass_clock(const pass_context *c, const char *name)
{
    return (pass_timing){name, clock_wall_ms(), clock_cpu_ms(), c->tiles.occupied_count};
}

void pass_clock_stop(pass_context *c, pass_timing since)
{
    if (c->timing_count == PASS_MAX_TIMINGS) return;
    c->timings[c->timing_count++] =
        (pass_timing){since.name, clock_wall_ms() - since.wall_ms, clock_cpu_ms() - since.cpu_ms, since.tiles};
}

// ---- running a shader

static const gpu_image *picture_named(const pass_context *c, const pass_call *call, const char *name)
{
    for (const pass_picture *p = call->reads; p->name; p++)
        if (strcmp(p->name, name) == 0) return p->image;
    for (const pass_picture *p = call->writes; p->name; p++)
        if (strcmp(p->name, name) == 0) return p->image;
    if (call->seen) c = call->seen;
    if (strcmp(name, "depth_image") == 0) return &c->image[IMAGE_DEPTH];
    if (strcmp(name, "normal_image") == 0) return &c->image[IMAGE_NORMAL];
    return NULL;
}

static const gpu_buffer *buffer_named(const pass_call *call, const char *name)
{
    for (const pass_store *b = call->buffers; b->name; b++)
        if (strcmp(b->name, name) == 0) return b->buffer;
    return NULL;
}

// Everything that the program uses goes to its place.
static bool bind_all(const pass_context *c, const pass_call *call, const gpu_program *p, error *e)
{
    for (int i = 0; i < p->slot_count; i++) {
        const gpu_slot *s = &p->slots[i];
        if (s->kind == SLOT_OUTPUT) continue;
        const gpu_image *image = s->kind == SLOT_BUFFER ? NULL : picture_named(c, call, s->name);
        const gpu_buffer *buffer = s->kind == SLOT_BUFFER ? buffer_named(call, s->name) : NULL;
        if (strcmp(s->name, "environment_map") == 0) // the white one has no picture, and is not looked up
            gpu_bind_picture(s, call->environment ? call->environment : &c->environment);
        else if (image && image->id) {
            gpu_bind_picture(s, image);
            gpu_label(c->g, GL_TEXTURE, image->id, s->name);
        } else if (buffer && buffer->id)
            gpu_bind_buffer(s, buffer);
        else
            return err_set(e, ERR_GL, call->program, s->name, "the shader uses this, and its pass did not give it");
    }
    return true;
}

static const char *words_of(const pass_call *call) { return call->variant ? call->variant : ""; }

static const gpu_program *program_of(pass_context *c, const pass_call *call, bool drawn, error *e)
{
    const char *words = words_of(call);
    char file[64], defines[2 * VARIANT_TEXT];
    if (!variant_find(call->program, words)) {
        err_set(e, ERR_GL, call->program, NULL, "no row of passes/variants.h allows the variant '%s' of this shader", words);
        return NULL;
    }
    variant v = {{0}};
    snprintf(v.words, sizeof v.words, "%s", words);
    variant_add(&v, c->gb->camera.kind == CAMERA_ORTHOGRAPHIC, "ORTHOGRAPHIC");
    snprintf(file, sizeof file, "%s.comp", call->program);
    if (variant_defines(v.words, defines, sizeof defines)) return gpu_program_get(c->g, file, defines, drawn, e);
    err_set(e, ERR_GL, call->program, NULL, "the words of variant '%s' are too long", words);
    return NULL;
}

static void draw(pass_context *c, const pass_call *call, const gpu_program *p, const gpu_tiles *tiles)
{
    const gpu_image *targets[GPU_MAX_TARGETS] = {NULL};
    for (const pass_picture *w = call->writes; w->name; w++) {
        const gpu_slot *s = gpu_slot_of(p, w->name);
        if (s && s->unit >= 0 && s->unit < GPU_MAX_TARGETS) targets[s->unit] = w->image;
    }
    gpu_draw_tiles(c->g, tiles, call->everywhere, targets, GPU_MAX_TARGETS);
}

static int tiles_of(const pass_call *call, const gpu_tiles *t)
{
    return call->groups[0] ? 0 : call->everywhere ? t->columns * t->rows : t->occupied_count;
}

static bool run_call(pass_context *c, const pass_call *call, error *e)
{
    pass_timing clock = pass_clock(c, call->label ? call->label : call->program);
    const variant_row *row = variant_find(call->program, words_of(call));
    bool drawn = row && row->drawable && c->g->habits.draw && !call->exact;
    const gpu_program *p = program_of(c, call, drawn, e);
    if (!p) return false;
    gpu_tiles tiles = call->tiles ? *call->tiles : c->tiles;
    tiles.stop = c->stop;
    glUseProgram(p->id);
    glBindBufferBase(GL_UNIFORM_BUFFER, FRAME_BINDING, (call->seen ? call->seen : c)->frame_uniforms);
    if (call->params) gpu_uniforms_set(c->params_uniforms, PARAMS_BINDING, call->params, call->params_size);
    if (!bind_all(c, call, p, e)) return false;
    if (call->groups[0])
        gpu_dispatch_groups(c->g, call->groups[0], call->groups[1], call->range[0], call->range[1]);
    else if (drawn)
        draw(c, call, p, &tiles);
    else
        gpu_dispatch_tiles(c->g, &tiles, call->everywhere);
    if (call->untimed) return true;
    if (c->timing && !gpu_finish(c->g, clock.name, e)) return false;
    clock.tiles = tiles_of(call, &tiles);
    pass_clock_stop(c, clock);
    return true;
}

bool pass_run(pass_context *c, const pass_call *call, error *e)
{
    gpu_group_begin(c->g, call->label ? call->label : call->program);
    bool ok = run_call(c, call, e);
    gpu_group_end(c->g);
    return ok;
}
