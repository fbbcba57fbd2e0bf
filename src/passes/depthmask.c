#include <math.h>
#include <stdlib.h>

#include "base/sort.h"
#include "passes/params.h"
#include "passes/pass.h"

// Standard deviation of the Gaussian, as a share of the picture's diagonal, so that the look does not depend on resolution.
static const double SIGMA = 0.01;

// The depths that become 0 and 1: the 2nd and 98th percentile, so that no stray pixel sets the scale of the whole picture.
static void depth_range(const gbuffer *gb, float *near, float *far)
{
    enum { MOST = 4096 };
    float depths[MOST];
    size_t n = 0, count = (size_t)gb->width * (size_t)gb->height, stride = gb->valid / MOST + 1, seen = 0;
    for (size_t i = 0; i < count && n < MOST; i++)
        if (gb->depth[i] > 0.0f && seen++ % stride == 0) depths[n++] = gb->depth[i];
    *near = *far = 0.0f;
    if (n == 0) return;
    sort_floats(depths, n);
    *near = depths[n * 2 / 100];
    *far = depths[n * 98 / 100];
}

bool pass_depthmask(pass_context *c, error *e)
{
    depthmask_params params;
    float far;
    depth_range(c->gb, &params.near, &far);
    params.scale = far > params.near ? 1.0f / (far - params.near) : 0.0f;
    params.sigma = (float)(SIGMA * hypot(c->width, c->height));
    params.radius = (int)ceilf(3.0f * params.sigma);
    gpu_image sums = {0};
    const pass_call across = {
        .program = "depthmask",
        .variant = "ACROSS",
        .everywhere = true, // rows that hold no surface themselves are read by those that do
        PASS_PARAMS(params),
        .writes = {{"sums_image", &sums}},
    };
    const pass_call down = {
        .program = "depthmask",
        .variant = "DOWN",
        PASS_PARAMS(params),
        .reads = {{"sums_image", &sums}},
        .writes = {{"mask_image", &c->image[IMAGE_DEPTHMASK]}},
    };
    bool ok = pass_make(c, &sums, GL_RG32F, 0.0f, e) && pass_make_image(c, IMAGE_DEPTHMASK, e) && pass_run(c, &across, e) &&
              pass_run(c, &down, e);
    gpu_image_free(&sums);
    return ok;
}
