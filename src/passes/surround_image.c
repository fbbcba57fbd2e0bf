#include "passes/surround_image.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "passes/surround.h"

enum {
    SIDE = SURROUND_SIDE,
    COARSE = SURROUND_COARSE,
    LOOKS = 32
}; // LOOKS: a side, of the directions that the choice is made by

// ---- the maps

// The axes of the environment's map. Where the frame's world is the file's, they are the same for all frames, to the last bit.
static mat3 map_from_world(const pass_context *c)
{
    const mat3 map = c->env ? c->env->map_from_world : m3_identity();
    const mat3 turn = m3_mul(c->set.world_from_camera, m3_transpose(c->gb->camera.world_from_camera));
    double off = 0.0;
    for (int i = 0; i < 9; i++) off = fmax(off, fabs(turn.m[i / 3][i % 3] - (i % 4 == 0)));
    return off < 1e-9 ? map : m3_mul(map, turn);
}

static bool upload_maps(pass_context *c, surround_map *maps, int count, float (*shell)[2], float (*albedo)[4], error *e)
{
    pass_surround *s = c->surround;
    for (int i = 0; i < count; i++) {
        s->eye[i] = maps[i].eye, s->known[i] = maps[i].known;
        for (int k = 0; k < LOOKS * LOOKS; k++) {
            int step = SIDE / LOOKS, x = (k % LOOKS) * step + step / 2, y = (k / LOOKS) * step + step / 2;
            s->seen[i * LOOKS * LOOKS + k] = fabsf(maps[i].shell[y * SIDE + x][0]);
        }
    }
    bool ok = gpu_image_make(c->g, &s->shell, GL_RG32F, SIDE, SIDE * count, 1, e) &&
              gpu_image_make(c->g, &s->albedo, GL_RGBA32F, COARSE, COARSE * count, 1, e);
    if (ok) gpu_image_upload(c->g, &s->shell, 0, shell[0]);
    if (ok) gpu_image_upload(c->g, &s->albedo, 0, albedo[0]);
    return ok && gpu_finish(c->g, "the upload of the surround", e);
}

static bool make_maps(pass_context *c, mat3 turn, error *e)
{
    pass_surround *s = c->surround;
    surround_map maps[MAX_FURTHER];
    int map_of[MAX_FURTHER];
    surround_image_free(s);
    int count = surround_maps(c->views, c->view_count, map_of, maps);
    float(*shell)[2] = mem_zero((size_t)SIDE * SIDE * (size_t)count, sizeof *shell, e);
    float(*albedo)[4] = shell ? mem_zero((size_t)COARSE * COARSE * (size_t)count, sizeof *albedo, e) : NULL;
    s->seen = albedo ? mem_zero((size_t)LOOKS * LOOKS * (size_t)count, sizeof *s->seen, e) : NULL;
    for (int i = 0; s->seen && i < count; i++)
        maps[i].shell = shell + SIDE * SIDE * i, maps[i].albedo = albedo + COARSE * COARSE * i;
    bool ok = s->seen && surround_make(c->views, c->view_count, turn, c->threads, map_of, maps, count, e) &&
              upload_maps(c, maps, count, shell, albedo, e);
    free(albedo);
    free(shell);
    s->map_from_world = turn, s->count = count, s->ready = ok;
    return ok;
}

void surround_image_free(pass_surround *s)
{
    gpu_image_free(&s->shell);
    gpu_image_free(&s->albedo);
    gpu_image_free(&s->light);
    free(s->seen);
    *s = (pass_surround){0};
}

// ---- what their surfaces send

// A map that shows more than this share of all directions shows all of them: the rest is between its texels.
static const double ALL_AROUND = 0.98;

static bool shows_all(const pass_surround *s)
{
    for (int i = 0; i < s->count; i++)
        if (s->known[i] > ALL_AROUND) return true;
    return false;
}

static void put_suns(const pass_context *c, arc_params *p)
{
    const sun_set *set = &c->sunless->suns;
    p->suns = c->sunless->map.id ? set->count : 0;
    for (int i = 0; i < p->suns; i++) {
        params_put(p->sun_direction[i], set->suns[i].direction, 0);
        params_put(p->sun_light[i], v3_scale(v3(set->suns[i].flux[0], set->suns[i].flux[1], set->suns[i].flux[2]), 1.0 / M_PI),
                   0);
    }
}

bool surround_image_light(pass_context *c, error *e)
{
    enum { STEPS = 8 }; // of how open the unknown is, so that the light is seldom made again
    pass_surround *s = c->surround;
    double open = shows_all(s) ? 0.0 : round(STEPS * openness_mean(&c->set.outside)) / STEPS;
    arc_params params = {.sun_openness = (float)open};
    if (s->light.id && s->lit_open == open) return true;
    if (!pass_split_suns(c, e)) return false;
    put_suns(c, &params);
    const pass_call call = {
        .program = "surround_light",
        .label = "light of the surround",
        .groups = {COARSE / GROUP_SIDE, COARSE / GROUP_SIDE * s->count},
        .environment = c->sunless->map.id ? &c->sunless->map : NULL,
        PASS_PARAMS(params),
        .reads = {{"surround_image", &s->shell}, {"surround_albedo_image", &s->albedo}},
        .writes = {{"surround_light_image", &s->light}},
    };
    s->lit_open = open;
    return (s->light.id || gpu_image_make(c->g, &s->light, GL_RGBA32F, COARSE, COARSE * s->count, 1, e)) && pass_run(c, &call, e);
}

// ---- the maps of one frame

// Marks the directions from the frame's eye in which a map shows something that the frame does not, unless they are marked.
// Returns how many it marked; with `marks` NULL it only counts those that `marked` lacks.
static int show(const pass_context *c, int map, const bool *marked, bool *marks)
{
    const pass_surround *s = c->surround;
    const camera *cam = &c->gb->camera;
    const mat3 world_from_map = m3_transpose(s->map_from_world), camera_from_world = m3_transpose(cam->world_from_camera);
    bool here[LOOKS * LOOKS] = {0};
    int count = 0;
    for (int k = 0; k < LOOKS * LOOKS; k++) {
        float far = s->seen[map * LOOKS * LOOKS + k];
        vec3 d = surround_direction(k % LOOKS + 0.5, k / LOOKS + 0.5, LOOKS);
        if (far == 0.0f) continue;
        vec3 to = m3_apply(world_from_map, d); // from the frame's eye
        if (isfinite(far)) to = v3_sub(v3_add(s->eye[map], v3_scale(to, (double)far)), cam->origin);
        vec3 p = m3_apply(camera_from_world, to);
        double x = cam->fx * p.x / p.z + cam->cx, y = cam->fy * p.y / p.z + cam->cy;
        if (p.z > 0.0 && x >= 0.0 && y >= 0.0 && x < c->gb->width && y < c->gb->height) continue;
        size_t cell = surround_texel(m3_apply(s->map_from_world, to), LOOKS);
        count += !here[cell] && !marked[cell];
        here[cell] = true;
        if (marks) marks[cell] = true;
    }
    return count;
}

static void choose(pass_context *c)
{
    bool shown[LOOKS * LOOKS] = {0}, taken[MAX_FURTHER] = {0};
    for (c->map_count = 0; c->map_count < SURROUND_TRIES && c->map_count < c->surround->count; c->map_count++) {
        int best = -1, most = -1;
        for (int i = 0; i < c->surround->count; i++) {
            int n = taken[i] ? -1 : show(c, i, shown, NULL);
            if (n > most) most = n, best = i;
        }
        if (c->map_count > 0 && most == 0) return;
        show(c, best, shown, shown);
        taken[best] = true;
        c->maps[c->map_count] = best;
    }
}

bool surround_image_make(pass_context *c, error *e)
{
    const mat3 turn = map_from_world(c);
    const pass_surround *s = c->surround;
    bool kept = s->ready && memcmp(&turn, &s->map_from_world, sizeof turn) == 0;
    if (!kept && !make_maps(c, turn, e)) return false;
    if (c->map_count == 0) choose(c);
    return true;
}

void surround_image_put(const pass_context *c, arc_params *p)
{
    const pass_surround *s = c->surround;
    p->views = c->map_count;
    for (int i = 0; i < c->map_count; i++)
        params_put(p->view_eye[i], m3_apply(s->map_from_world, v3_sub(c->gb->camera.origin, s->eye[c->maps[i]])), c->maps[i]);
}
