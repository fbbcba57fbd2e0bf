// Passes over a list of pixels: those of the whole frame whose surface the frame of half the size does not show.
#include "passes/params.h"
#include "passes/pass.h"
#include "passes/variants.h"

enum { GROUP = GROUP_SIDE * GROUP_SIDE, BATCH = 128 * GROUP };

// A surface may bend by this many pixel footprints off the centre's tangent plane before its taps lose weight: as in blur.c.
static const float SHARPNESS = 1.0f;

// Batches stop soon when the job is stopped.
bool pass_run_list(pass_context *c, size_t count, pass_call call, error *e)
{
    call.untimed = true;
    for (size_t first = 0; first < count && !(c->stop && *c->stop); first += BATCH) {
        size_t end = first + BATCH < count ? first + BATCH : count;
        call.groups[0] = (int)((end - first + GROUP - 1) / GROUP), call.groups[1] = 1;
        call.range[0] = (int)first, call.range[1] = (int)end;
        if (!pass_run(c, &call, e)) return false;
    }
    return true;
}

static bool run_over(pass_context *c, size_t count, const gpu_buffer *lone, pass_call call, error *e)
{
    int free_place = 0;
    while (call.buffers[free_place].name) free_place++;
    call.buffers[free_place] = (pass_store){"Lone", lone};
    return pass_run_list(c, count, call, e);
}

static bool filter(pass_context *c, size_t count, const gpu_buffer *lone, const gpu_image *scalar, const gpu_image *colour,
                   error *e)
{
    gpu_buffer filtered = {0};
    const blur_params params = {.radius = c->set.blur, .sharpness = SHARPNESS};
    bool ok = gpu_buffer_make(c->g, &filtered, NULL, count * 4 * sizeof(float), "single pixels", e);
    for (int scatter = 0; ok && scatter < 2; scatter++) {
        variant v = {{0}};
        variant_add(&v, scalar && scalar->id, "VISIBILITY");
        variant_add(&v, scatter, "SCATTER");
        ok = run_over(c, count, lone,
                      (pass_call){.program = "lone_blur",
                                  .variant = v.words,
                                  PASS_PARAMS(params),
                                  .writes = {{"colour_image", colour}, {"scalar_image", scalar}},
                                  .buffers = {{"Filtered", &filtered}}},
                      e);
    }
    gpu_buffer_free(&filtered);
    return ok;
}

bool pass_at_lone(pass_context *c, const pixel_list *list, const pass_call *march, image_set made, error *e)
{
    gpu_buffer lone = {0};
    pass_timing clock = pass_clock(c, "refine");
    bool ok = gpu_buffer_make(c->g, &lone, list->pixels, list->count * sizeof *list->pixels, "single pixels", e) &&
              run_over(c, list->count, &lone, *march, e);
    if (ok && c->set.blur > 0 && made & IMAGE_BIT(IMAGE_RADIANCE))
        ok = filter(c, list->count, &lone, made & IMAGE_BIT(IMAGE_VISIBILITY) ? &c->image[IMAGE_VISIBILITY] : NULL,
                    &c->image[IMAGE_RADIANCE], e);
    if (ok && c->set.blur > 0 && made & IMAGE_BIT(IMAGE_INDIRECT))
        ok = filter(c, list->count, &lone, NULL, &c->image[IMAGE_INDIRECT], e);
    ok = ok && (!c->timing || gpu_finish(c->g, "refine", e));
    pass_clock_stop(c, clock);
    gpu_buffer_free(&lone);
    return ok;
}
