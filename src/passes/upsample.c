#include "passes/params.h"
#include "passes/pass.h"
#include "passes/variants.h"

// A surface may bend by this many footprints of a small pixel off the pixel's tangent plane before a tap loses weight.
static const float SHARPNESS = 0.5f;
// On the way down a pixel counts if it lies this near the small one's tangent plane, in its own footprints, and its normal has at
// least this cosine with the small one's: as gbuffer/half_size.c brings colours down.
static const float NEAR = 2.0f, LIKE = 0.7f;

enum { SCALARS = 2, COLOURS = 2 }; // of a draw

// Images on their way; those of a draw share the weights of the taps.
typedef struct draw {
    image_id scalars[SCALARS], colours[COLOURS];
    int scalar_count, colour_count;
} draw;

static bool bring(pass_context *c, const pass_context *small, const draw *d, error *e)
{
    static const char *const in[] = {"scalar0_in", "scalar1_in", "colour0_in", "colour1_in"}, *const out[] = {
                                                                                                  "scalar0_out", "scalar1_out",
                                                                                                  "colour0_out", "colour1_out"};
    upsample_params params = {.small_size = {small->width, small->height}, .sharpness = SHARPNESS};
    pass_call call = {.program = "upsample",
                      PASS_PARAMS(params),
                      .reads = {{"small_depth", &small->image[IMAGE_DEPTH]}, {"small_normal", &small->image[IMAGE_NORMAL]}}};
    variant v = {{0}};
    bool open_light = d->colour_count > 0 && image_table[d->colours[0]].resampled == AS_OPEN_LIGHT;
    for (int i = 0; open_light && i < 9; i++)
        for (int k = 0; k < 3; k++) params.light[i][k] = (float)(small->suns_pending ? c->sunless->rest[i][k] : c->env->sh[i][k]);
    for (int k = 0; k < d->scalar_count + d->colour_count; k++) {
        bool colour = k >= d->scalar_count;
        int place = colour ? SCALARS + k - d->scalar_count : k;
        image_id id = colour ? d->colours[k - d->scalar_count] : d->scalars[k];
        if (!pass_make_image(c, id, e)) return false;
        call.reads[2 + k] = (pass_picture){in[place], &small->image[id]};
        call.writes[k] = (pass_picture){out[place], &c->image[id]};
    }
    variant_number(&v, "SCALARS", d->scalar_count);
    variant_number(&v, "COLOURS", d->colour_count);
    variant_add(&v, open_light, "OPEN_LIGHT");
    call.variant = v.words;
    return pass_run(c, &call, e);
}

// The next image from `*at` on that is resampled in this way and has to come; false after the last.
static bool next_of(const pass_context *c, const pass_context *small, image_set which, bool colour, int *at, image_id *found)
{
    for (; *at < IMAGE_COUNT; (*at)++) {
        image_resampling as = image_table[*at].resampled;
        if (as == AS_NOTHING || (as != AS_SCALAR) != colour || !(which & IMAGE_BIT(*at))) continue;
        if (!small->image[*at].id || c->image[*at].id) continue;
        *found = (image_id)(*at)++;
        return true;
    }
    return false;
}

bool pass_upsample(pass_context *c, const pass_context *small, image_set which, error *e)
{
    int scalar = 0, colour = 0;
    if (which & (IMAGE_BIT(IMAGE_RADIANCE) | IMAGE_BIT(IMAGE_VISIBILITY))) c->suns_pending = small->suns_pending;
    for (;;) {
        draw d = {.scalar_count = 0};
        while (d.scalar_count < SCALARS && next_of(c, small, which, false, &scalar, &d.scalars[d.scalar_count])) d.scalar_count++;
        while (d.colour_count < COLOURS && next_of(c, small, which, true, &colour, &d.colours[d.colour_count])) d.colour_count++;
        if (d.scalar_count + d.colour_count == 0) return true;
        if (!bring(c, small, &d, e)) return false;
    }
}

bool pass_downsample(pass_context *c, const pass_context *whole, image_set which, error *e)
{
    const downsample_params params = {.whole_size = {whole->width, whole->height}, .near = NEAR, .like = LIKE};
    for (int i = 0; i < IMAGE_COUNT; i++) {
        if (!(which & IMAGE_BIT(i))) continue;
        const pass_call call = {.program = "downsample",
                                PASS_PARAMS(params),
                                .reads = {{"whole_depth", &whole->image[IMAGE_DEPTH]},
                                          {"whole_normal", &whole->image[IMAGE_NORMAL]},
                                          {"colour_in", &whole->image[i]}},
                                .writes = {{"colour_out", &c->image[i]}}};
        if (!pass_make_image(c, (image_id)i, e) || !pass_run(c, &call, e)) return false;
    }
    return true;
}
