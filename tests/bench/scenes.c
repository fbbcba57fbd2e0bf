#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/mem.h"
#include "base/threads.h"
#include "bench.h"

bool bench_light(bench_scene *b, const char *path, double rotate, rig *r, error *e)
{
    env_options eo = {
        .path = path && *path ? path : NULL, .up_z = true, .rotate_degrees = rotate, .scale = 1.0, .threads = threads_default()};
    b->sunless = mem_zero(1, sizeof *b->sunless, e);
    return b->sunless && environment_load(&eo, &b->env, &r->log, e) &&
           pass_upload_environment(&r->job.g, &b->env, &b->env_image, e);
}

bool bench_prepare(bench_scene *b, error *e)
{
    if (!layer_build(&b->gb, &b->layer, e)) return false;
    b->pixels = mem_pixels(BENCH_PIXELS, sizeof *b->pixels, e);
    if (!b->pixels) return false;
    b->pixel_count = reference_pixels(&b->layer, BENCH_PIXELS, b->pixels);
    return b->pixel_count > 0 || err_set(e, ERR_INPUT, b->s.file, NULL, "this scene shows no surface");
}

static bool build_gbuffer(const char *path, gbuffer *out, log_t *log, error *e)
{
    exrio_file *f = NULL;
    resolution res;
    resolve_options ro = {0};
    bool ok = exrio_file_open(path, &f, e) && resolve_channels(f, &ro, &res, log, e);
    for (int i = 0; ok && i < ROLE_COUNT; i++)
        for (int k = 0; k < res.components[i]; k++)
            f->parts[res.channels[i][k].part].channels[res.channels[i][k].channel].wanted = true;
    gbuffer_options g = {.need = NEED_ALBEDO, .threads = threads_default()};
    ok = ok && exrio_file_load(f, g.threads, e) && gbuffer_build(f, &res, &g, out, log, e);
    exrio_file_close(f);
    return ok;
}

static void find_mesh(bench_scene *b, const char *meshes)
{
    if (!meshes) return;
    snprintf(b->mesh, sizeof b->mesh, "%s/%s.obj", meshes, b->s.name);
    if (access(b->mesh, R_OK) != 0) b->mesh[0] = 0;
}

int bench_samples(const char *dir, const char *meshes, rig *r, bench_scene *list, int max, error *e)
{
    sample found[SAMPLE_MAX];
    int n = samples_list(dir, found, max < SAMPLE_MAX ? max : SAMPLE_MAX, e), kept = 0;
    for (int i = 0; i < n; i++) {
        bench_scene *b = &list[kept];
        *b = (bench_scene){.s = found[i], .radius = found[i].ao_distance};
        if (!b->s.truth[0]) continue;
        if (!sample_load(&b->s, e) || !build_gbuffer(b->s.file, &b->gb, &r->log, e) ||
            !bench_light(b, b->s.env, b->s.env_rotate, r, e) || !bench_prepare(b, e) || !bench_middle(b, dir, e))
            return 0;
        find_mesh(b, meshes);
        kept++;
    }
    return kept;
}

void bench_scene_free(bench_scene *b)
{
    bench_middle_free(b);
    sample_free(&b->s);
    gbuffer_free(&b->gb);
    gpu_image_free(&b->env_image);
    if (b->sunless) gpu_image_free(&b->sunless->map);
    free(b->sunless);
    if (b->env.level_count) environment_free(&b->env);
    layer_free(&b->layer);
    free(b->pixels);
    *b = (bench_scene){0};
}

int bench_open(const char *dir, rig *r, bench_scene *list, error *e)
{
    return rig_open(r, NULL, e) ? bench_samples(dir, NULL, r, list, BENCH_SCENES, e) : 0;
}

void bench_close(rig *r, bench_scene *list, int count)
{
    for (int i = 0; i < count; i++) bench_scene_free(&list[i]);
    rig_close(r);
}

int bench_end(const char *program, bool ok, const error *e)
{
    char text[1600];
    if (ok) return 0;
    err_format(e, text, sizeof text);
    fprintf(stderr, "%s: %s\n", program, text);
    return (int)e->code;
}
