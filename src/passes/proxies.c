#include <stdlib.h>

#include "base/mem.h"
#include "passes/params.h"
#include "passes/pass.h"
#include "passes/variants.h"

// Centre in camera space and radius; albedo.
static bool upload(pass_context *c, gpu_image *image, error *e)
{
    size_t n = (size_t)c->proxies->count;
    float *v = mem_zero(2 * 4 * n, sizeof *v, e);
    if (!v) return false;
    for (size_t i = 0; i < n; i++) {
        const sphere_proxy *s = &c->proxies->spheres[i];
        vec3 at = camera_from_world(&c->gb->camera, s->centre);
        float *place = v + 4 * i, *albedo = v + 4 * (n + i);
        place[0] = (float)at.x, place[1] = (float)at.y, place[2] = (float)at.z, place[3] = (float)s->radius;
        for (int k = 0; k < 3; k++) albedo[k] = (float)s->albedo[k];
    }
    bool ok = gpu_image_make(c->g, image, GL_RGBA32F, c->proxies->count, 2, 1, e);
    if (ok) gpu_image_upload(c->g, image, 0, v);
    free(v);
    return ok;
}

typedef struct proxy_run {
    pass_context *c;
    proxies_params params;
    gpu_image spheres;
} proxy_run;

static bool begin(proxy_run *r, pass_context *c, error *e)
{
    *r = (proxy_run){
        .c = c,
        .params = {.radius = (float)c->set.radius, .count = c->proxies->count, .strength = (float)c->set.bounce_strength}};
    return upload(c, &r->spheres, e);
}

static bool block(const proxy_run *r, unsigned group, const char *label, bool with_vector, error *e)
{
    variant v = {{0}};
    pass_call call = {.program = "proxies",
                      .label = label,
                      .variant = v.words,
                      PASS_PARAMS(r->params),
                      .reads = {{"sphere_image", &r->spheres}}};
    variant_add(&v, with_vector, "VECTOR");
    return !pass_add_group(r->c, group, &v, call.writes) || pass_run(r->c, &call, e);
}

bool pass_proxies(pass_context *c, error *e)
{
    proxy_run r;
    if (!c->proxies || c->proxies->count == 0) return true;
    bool ok = begin(&r, c, e) && block(&r, IMAGE_BLOCKED, "proxies", c->image[IMAGE_SH_0].id != 0, e) &&
              block(&r, IMAGE_VECTOR, "proxies sh", false, e);
    gpu_image_free(&r.spheres);
    return ok;
}

bool pass_proxies_bounce(pass_context *c, error *e)
{
    proxy_run r;
    if (!c->proxies || c->proxies->count == 0) return true;
    bool ok = begin(&r, c, e);
    const pass_call call = {
        .program = "proxies",
        .label = "proxies bounce",
        .variant = "BOUNCE",
        PASS_PARAMS(r.params),
        .reads = {{"sphere_image", &r.spheres}},
        .writes = {{"indirect_image", &c->image[IMAGE_INDIRECT]}},
    };
    ok = ok && pass_run(c, &call, e);
    gpu_image_free(&r.spheres);
    return ok;
}
