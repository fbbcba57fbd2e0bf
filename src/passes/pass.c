#include "passes/pass.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "gpu/transfer.h"

// The std140 block of shaders/include/frame.glsl, in its order.
typedef struct frame_block {
    float lens[4];
    int size[4];
    float map_from_camera[3][4];
    float env[4];
    float sh[9][4];
} frame_block;

static double now(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

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

static bool upload(pass_context *c, const char *name, gpu_image *image, GLenum format, const float *pixels, error *e)
{
    if (!pixels) return true;
    if (!gpu_image_make(c->g, image, format, c->width, c->height, 1, e)) return false;
    if (!gpu_image_send(c->g, image, pixels, e)) return false;
    size_t components = format == GL_R32F ? 1 : format == GL_RG32F ? 2 : 4;
    size_t bytes = (size_t)c->width * (size_t)c->height * components * sizeof *pixels;
    c->uploads[c->upload_count++] = (pass_upload){name, bytes};
    return true;
}

static bool upload_all(pass_context *c, const gbuffer *gb, error *e)
{
    const struct {
        const char *name;
        gpu_image *image;
        GLenum format;
        const float *pixels;
    } list[] = {
        {"depth", &c->depth, GL_R32F, gb->depth},
        {"normal", &c->normal, GL_RGBA32F, gb->normal},
        {"albedo", &c->albedo, GL_RGBA32F, gb->albedo},
        {"beauty", &c->beauty, GL_RGBA32F, gb->beauty},
        {"material", &c->material, GL_RG32F, gb->material},
        {"emission", &c->emission, GL_RGBA32F, gb->emission},
        {"diffuse direct", &c->diffuse_direct, GL_RGBA32F, gb->diffuse_direct},
        {"coverage", &c->coverage, GL_R32F, gb->coverage},
    };
    for (size_t i = 0; i < sizeof list / sizeof *list; i++)
        if (!upload(c, list[i].name, list[i].image, list[i].format, list[i].pixels, e)) return false;
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

bool pass_begin(pass_context *c, gpu *g, const gbuffer *gb, const environment *env, const pass_settings *set, bool timing,
                log_t *log, error *e)
{
    *c = (pass_context){
        .g = g, .log = log, .timing = timing, .width = gb->width, .height = gb->height, .set = *set, .gb = gb, .env = env};
    double wall = now(CLOCK_MONOTONIC), cpu = now(CLOCK_PROCESS_CPUTIME_ID);
    bool ok = upload_all(c, gb, e) &&
              gpu_tiles_make(&c->tiles, c->width, c->height, gpu_tile_size(g, set->samples), gb->depth, gb->coverage, e) &&
              gpu_finish(g, "the upload", e);
    if (!ok) {
        pass_end(c);
        return false;
    }
    frame_block block;
    fill_block(&block, gb, env, set->world_from_camera);
    c->frame_uniforms = gpu_uniforms_make(sizeof block);
    gpu_uniforms_set(c->frame_uniforms, 0, &block, sizeof block);
    c->params_uniforms = gpu_uniforms_make(512);
    c->timings[c->timing_count++] = (pass_timing){"upload", now(CLOCK_MONOTONIC) - wall, now(CLOCK_PROCESS_CPUTIME_ID) - cpu, 0};
    return true;
}

void pass_end(pass_context *c)
{
    gpu_image *images[] = {&c->depth,          &c->normal,        &c->albedo,    &c->beauty,     &c->material,  &c->emission,
                           &c->diffuse_direct, &c->coverage,      &c->occlusion, &c->visibility, &c->radiance,  &c->indirect,
                           &c->specular,       &c->diffuse_share, &c->composite, &c->diffuse,    &c->depthmask, &c->bent,
                           &c->sh[0],          &c->sh[1],         &c->sh[2],     &c->sh[3],      &c->sh[4],     &c->surface,
                           &c->plane_image,    &c->change,        &c->error};
    for (size_t i = 0; i < sizeof images / sizeof *images; i++) gpu_image_free(images[i]);
    gpu_uniforms_free(c->frame_uniforms);
    gpu_uniforms_free(c->params_uniforms);
    gpu_tiles_free(&c->tiles);
    gpu_tiles_free(&c->rounds.tiles);
    free(c->rounds.last);
    c->rounds.last = NULL;
    c->frame_uniforms = c->params_uniforms = 0;
}

bool pass_make(pass_context *c, gpu_image *image, GLenum format, float value, error *e)
{
    if (image->id) return true;
    if (!gpu_image_make(c->g, image, format, c->width, c->height, 1, e)) return false;
    gpu_image_clear(image, (float[4]){value, value, value, value});
    return true;
}

pass_timing pass_clock(const char *name) { return (pass_timing){name, now(CLOCK_MONOTONIC), now(CLOCK_PROCESS_CPUTIME_ID), 0}; }

void pass_clock_stop(pass_context *c, pass_timing since)
{
    if (c->timing_count == PASS_MAX_TIMINGS) return;
    c->timings[c->timing_count++] = (pass_timing){since.name, now(CLOCK_MONOTONIC) - since.wall_ms,
                                                  now(CLOCK_PROCESS_CPUTIME_ID) - since.cpu_ms, c->tiles.occupied_count};
}

GLuint pass_program(pass_context *c, const char *file, const char *defines, error *e)
{
    char all[256];
    snprintf(all, sizeof all, "%s%s", c->gb->camera.kind == CAMERA_ORTHOGRAPHIC ? "ORTHOGRAPHIC 1\n" : "",
             defines ? defines : "");
    return gpu_program(c->g, file, all, e);
}

// What dispatched and drawn passes have in common: program, blocks and images in place.
static bool set_up(pass_context *c, const char *file, const char *defines, const void *params, size_t params_size,
                   const pass_binding *bindings, int binding_count, error *e)
{
    GLuint program = pass_program(c, file, defines, e);
    if (!program) return false;
    glUseProgram(program);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, c->frame_uniforms);
    if (params) gpu_uniforms_set(c->params_uniforms, 1, params, params_size);
    gpu_bind_image(0, &c->depth, GL_READ_ONLY);
    gpu_bind_image(1, &c->normal, GL_READ_ONLY);
    glBindTextureUnit(0, c->environment.id);
    for (int i = 0; i < binding_count; i++) gpu_bind_image(bindings[i].unit, bindings[i].image, bindings[i].access);
    return true;
}

static bool note_time(pass_context *c, const char *name, double wall, double cpu, bool everywhere, error *e)
{
    if (c->timing && !gpu_finish(c->g, name, e)) return false;
    if (c->timing_count < PASS_MAX_TIMINGS)
        c->timings[c->timing_count++] = (pass_timing){name, now(CLOCK_MONOTONIC) - wall, now(CLOCK_PROCESS_CPUTIME_ID) - cpu,
                                                      everywhere ? c->tiles.columns * c->tiles.rows : c->tiles.occupied_count};
    return true;
}

bool pass_run(pass_context *c, const char *name, const char *defines, const void *params, size_t params_size,
              const pass_binding *bindings, int binding_count, bool everywhere, error *e)
{
    double wall = now(CLOCK_MONOTONIC), cpu = now(CLOCK_PROCESS_CPUTIME_ID);
    char file[64];
    snprintf(file, sizeof file, "%.*s.comp", (int)strcspn(name, " "), name);
    if (!set_up(c, file, defines, params, params_size, bindings, binding_count, e)) return false;
    gpu_dispatch_tiles(c->g, &c->tiles, everywhere);
    return note_time(c, name, wall, cpu, everywhere, e);
}

bool pass_draw(pass_context *c, const char *name, const char *defines, const void *params, size_t params_size,
               const pass_binding *bindings, int binding_count, const gpu_image *const targets[], int target_count,
               bool everywhere, error *e)
{
    double wall = now(CLOCK_MONOTONIC), cpu = now(CLOCK_PROCESS_CPUTIME_ID);
    char file[64];
    snprintf(file, sizeof file, "%s.frag", name);
    if (!set_up(c, file, defines, params, params_size, bindings, binding_count, e)) return false;
    gpu_draw_tiles(c->g, &c->tiles, everywhere, targets, target_count);
    return note_time(c, name, wall, cpu, everywhere, e);
}
