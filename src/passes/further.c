#include "passes/further.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"

// Pictures stand one below the other, in columns of at most this height.
enum { COLUMN = 8192 };

// An eye nearer than this share of the frame's extent, looking the same way, shows what the frame shows.
static const double SAME_EYE = 1e-5, SAME_TURN = 1e-6;

static bool is_own(const pass_context *c, const world_view *v)
{
    const camera *own = &c->gb->camera;
    if (v3_length(v3_sub(v->camera.origin, own->origin)) > SAME_EYE * c->gb->extent) return false;
    for (int i = 0; i < 9; i++)
        if (fabs(v->camera.world_from_camera.m[i / 3][i % 3] - own->world_from_camera.m[i / 3][i % 3]) > SAME_TURN) return false;
    return true;
}

static bool serves(const pass_context *c, const world_view *v)
{
    return v->surface && c->gb->camera.has_world && c->gb->camera.kind == CAMERA_PERSPECTIVE && !is_own(c, v);
}

bool further_serves(const pass_context *c)
{
    for (int i = 0; i < c->view_count; i++)
        if (serves(c, &c->views[i])) return true;
    return false;
}

// Where each picture stands.
typedef struct place {
    int x, y;
} place;

static place lay_out(const pass_context *c, place at[MAX_FURTHER])
{
    place next = {0}, end = {0};
    for (int i = 0; i < c->view_count; i++) {
        const world_view *v = &c->views[i];
        if (!v->surface) continue;
        if (next.y > 0 && next.y + v->height > COLUMN) next = (place){end.x, 0};
        at[i] = next;
        next.y += v->height;
        end.x = end.x > next.x + v->width ? end.x : next.x + v->width;
        end.y = end.y > next.y ? end.y : next.y;
    }
    return end;
}

bool further_make(pass_context *c, error *e)
{
    place at[MAX_FURTHER];
    if (!further_serves(c) || c->further->id) return true;
    place size = lay_out(c, at);
    if (c->g->max_size > 0 && (size.x > c->g->max_size || size.y > c->g->max_size))
        return err_set(e, ERR_GL, NULL, NULL, "the further G-buffers are more than this GL device's %d pixels a side; give fewer",
                       c->g->max_size);
    float *all = mem_zero((size_t)size.x * (size_t)size.y, 4 * sizeof *all, e);
    if (!all) return false;
    for (int i = 0; i < c->view_count; i++) {
        const world_view *v = &c->views[i];
        size_t row = 4 * (size_t)v->width;
        for (int y = 0; v->surface && y < v->height; y++)
            memcpy(all + 4 * ((size_t)(at[i].y + y) * (size_t)size.x + (size_t)at[i].x), v->surface + (size_t)y * row,
                   row * sizeof *all);
    }
    bool ok = gpu_image_make(c->g, c->further, GL_RGBA32F, size.x, size.y, 1, e);
    if (ok) gpu_image_upload(c->g, c->further, 0, all);
    free(all);
    return ok && gpu_finish(c->g, "the upload of further G-buffers", e);
}

static void put_view(const pass_context *c, const world_view *v, place at, arc_params *p)
{
    const mat3 to_view = m3_transpose(v->camera.world_from_camera);
    const mat3 turn = m3_mul(to_view, c->gb->camera.world_from_camera);
    const vec3 eye = m3_apply(to_view, v3_sub(c->gb->camera.origin, v->camera.origin));
    const int k = p->further++;
    for (int r = 0; r < 3; r++)
        params_put(p->further_rows[3 * k + r], v3(turn.m[r][0], turn.m[r][1], turn.m[r][2]),
                   r == 0   ? eye.x
                   : r == 1 ? eye.y
                            : eye.z);
    params_put(p->further_lens[k], v3(v->camera.fx, v->camera.fy, v->camera.cx), v->camera.cy);
    params_put(p->further_size[k], v3(v->width, v->height, at.x), at.y);
}

void further_put(const pass_context *c, arc_params *p)
{
    place at[MAX_FURTHER];
    lay_out(c, at);
    for (int i = 0; i < c->view_count; i++)
        if (serves(c, &c->views[i])) put_view(c, &c->views[i], at[i], p);
}
