// libFuzzer target: a camera file, and behind a line "%%" a file of spheres.
#include <math.h>

#include "fuzz.h"
#include "gbuffer/camera.h"
#include "light/proxies.h"

static void check_camera(const camera *c)
{
    CHECK(c->fx > 0.0 && c->fy > 0.0 && isfinite(c->cx) && isfinite(c->cy));
    if (c->has_world) CHECK(fabs(m3_det(c->world_from_camera) - 1.0) < 0.01 && v3_finite(c->origin));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static int fd = -1;
    char path[64], *spheres, *text = fuzz_text(data, size, &spheres);
    camera c = {0};
    error e = {0};
    proxy_set set;
    fuzz_file(&fd, path, text, strlen(text));
    bool ok = camera_from_json(path, (box2){0, 0, 99, 49}, (box2){0, 0, 99, 49}, 1.0, &c, &e);
    check_error(ok, &e);
    if (ok) check_camera(&c);
    fuzz_file(&fd, path, spheres, strlen(spheres));
    e = (error){0};
    ok = proxies_load(path, &set, &e);
    check_error(ok, &e);
    for (int i = 0; ok && i < set.count; i++)
        CHECK(v3_finite(set.spheres[i].centre) && set.spheres[i].radius > 0.0 && set.spheres[i].albedo[0] <= 1.0);
    if (ok) proxies_free(&set);
    free(text);
    return 0;
}
