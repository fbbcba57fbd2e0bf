// Light that surfaces send, before their own light is made. One march can then make light and bounce at once, which is cheaper
// than a march for each. A bounce is a mean over many senders, so an estimate from a quarter of the receivers serves it.
#include "passes/arc.h"

// A wider filter takes the dark out of contacts; the bounce averages the noise that this one leaves.
enum { BLUR = 1 };

// Radiance of the smaller frame `q`, brought to the frame of `c`.
static bool light_from(pass_context *q, pass_context *c, error *e)
{
    return arc_run_light(q, &(arc_light){.sky = true}, e) &&
           pass_blur(q, &(pass_blurring){.radius = BLUR, .colours = {&q->image[IMAGE_RADIANCE]}}, e) &&
           pass_upsample(c, q, IMAGE_BIT(IMAGE_RADIANCE), e);
}

// The same of the pixels of `c` whose surface the smaller frame does not show.
static bool light_lone(pass_context *c, const pixel_list *lone, error *e)
{
    return !lone || lone->count == 0 || arc_run_light(c, &(arc_light){.sky = true, .lone = lone}, e);
}

// In the place of the radiance of `c`, which is not made yet.
static bool estimate(pass_context *c, pass_context *seen, error *e)
{
    gbuffer own = *c->gb, smaller; // borrows its arrays
    own.albedo = own.beauty = NULL;
    if (!gbuffer_halve(&own, c->threads, &smaller, e)) return false;
    if (seen != c) gbuffer_quarter_places(&own, &smaller);
    pass_context q = pass_like(c, &smaller, &c->set);
    q.whole = seen, q.whole_side = seen == c ? 2 : 4;
    pixel_list lone = {0};
    bool ok = gbuffer_lone(&own, &smaller, c->threads, &lone, e) && pass_begin(&q, e) && light_from(&q, c, e) &&
              light_lone(c, &lone, e);
    pass_take_timings(c, &q);
    pass_end(&q);
    gbuffer_free(&smaller);
    pixel_list_free(&lone);
    return ok && (seen == c || (pass_upsample(seen, c, IMAGE_BIT(IMAGE_RADIANCE), e) && light_lone(seen, seen->lone, e)));
}

static void move(gpu_image *from, gpu_image *to)
{
    *to = *from;
    *from = (gpu_image){0};
}

bool arc_first_light(pass_context *c, error *e)
{
    pass_context *seen = c->whole ? c->whole : c;
    if (seen->image[IMAGE_FIRST_LIGHT].id) return true;
    bool ok = estimate(c, seen, e);
    move(&seen->image[IMAGE_RADIANCE], &seen->image[IMAGE_FIRST_LIGHT]);
    if (seen != c) gpu_image_free(&c->image[IMAGE_RADIANCE]);
    bool suns = seen->suns_pending;
    seen->suns_pending = false;
    return ok && (!suns || pass_add_suns(seen, &seen->image[IMAGE_FIRST_LIGHT], NULL, e));
}
