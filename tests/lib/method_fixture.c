#include "method_fixture.h"

#include "base/threads.h"

bool fixture_open(fixture *f, const scene *s, const view *v, int pixels, error *e)
{
    *f = (fixture){.s = *s, .v = *v};
    if (!scene_gbuffer(s, v, &f->gb, e) || !layer_build(&f->gb, &f->l, e)) return false;
    f->count = reference_pixels(&f->l, pixels < FIXTURE_PIXELS ? pixels : FIXTURE_PIXELS, f->pixels);
    return f->count > 0 || err_set(e, ERR_INPUT, NULL, NULL, "the scene shows no surface");
}

void fixture_close(fixture *f)
{
    layer_free(&f->l);
    gbuffer_free(&f->gb);
}

typedef struct expectation {
    fixture *f;
    method_reference_options options;
} expectation;

static bool expect_pixel(void *context, size_t i, int worker)
{
    (void)worker;
    expectation *x = context;
    x->f->expected[i] = method_reference(&x->f->l, x->f->pixels[i], &x->options).occlusion;
    return true;
}

void fixture_expect(fixture *f, const method *m, const pass_settings *set, bool fine)
{
    expectation x = {f, {.method = m, .set = set, .fine = fine}};
    threads_for(threads_default(), (size_t)f->count, expect_pixel, &x);
}

bool fixture_compare(const fixture *f, rig *r, const method *m, const pass_settings *set, figures *out, error *e)
{
    frame_result frame;
    *out = (figures){0};
    if (!rig_run(r, &f->gb, m, set, 1u << LAYER_OCCLUSION, &frame, e)) return false;
    for (int i = 0; i < f->count; i++) {
        double d = (double)frame.layers[LAYER_OCCLUSION][f->pixels[i].y * f->gb.width + f->pixels[i].x] - f->expected[i];
        out->rmse += d * d / f->count;
        out->bias += d / f->count;
    }
    out->rmse = sqrt(out->rmse);
    rig_free_result(&frame);
    return true;
}
