#include <stdio.h>
#include <stdlib.h>

#include "base/mem.h"
#include "passes/pass.h"

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

static bool run(pass_context *c, const char *defines, const pass_binding *layers, int count, error *e)
{
    struct {
        float radius;
        int count;
        float strength;
        int unused;
    } params = {(float)c->set.radius, c->proxies->count, (float)c->set.bounce_strength, 0};
    gpu_image spheres = {0};
    pass_binding bindings[10] = {{2, &spheres, GL_READ_ONLY}};
    for (int i = 0; i < count; i++) bindings[1 + i] = layers[i];
    bool ok = upload(c, &spheres, e) && pass_run(c, "proxies", defines, &params, sizeof params, bindings, 1 + count, false, e);
    gpu_image_free(&spheres);
    return ok;
}

bool pass_proxies(pass_context *c, error *e)
{
    if (!c->proxies || c->proxies->count == 0) return true;
    char defines[96];
    snprintf(defines, sizeof defines, "%s%s%s%s%s", c->radiance.id ? "RADIANCE 1\n" : "",
             c->visibility.id ? "VISIBILITY 1\n" : "", c->bent.id ? "BENT 1\n" : "", c->sh[0].id ? "VECTOR 1\n" : "",
             c->sh[3].id ? "BANDS3 1\n" : "");
    const pass_binding layers[] = {
        {3, &c->occlusion, GL_READ_WRITE}, {4, &c->visibility, GL_READ_WRITE}, {5, &c->radiance, GL_READ_WRITE},
        {6, &c->bent, GL_READ_WRITE},      {7, &c->sh[0], GL_READ_WRITE},      {8, &c->sh[1], GL_READ_WRITE},
        {9, &c->sh[2], GL_READ_WRITE},     {10, &c->sh[3], GL_READ_WRITE},     {11, &c->sh[4], GL_READ_WRITE}};
    return run(c, defines, layers, 9, e);
}

bool pass_proxies_bounce(pass_context *c, error *e)
{
    if (!c->proxies || c->proxies->count == 0) return true;
    const pass_binding layers[] = {{3, &c->indirect, GL_READ_WRITE}};
    return run(c, "BOUNCE 1\n", layers, 1, e);
}
