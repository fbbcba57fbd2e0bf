#include "pipeline/steps.h"

#include <string.h>

#include "passes/arc.h"

#define BIT(id) IMAGE_BIT(IMAGE_##id)

static const image_set LIGHT = BIT(RADIANCE) | BIT(VISIBILITY);

typedef struct builder {
    const step_facts *f;
    step_list *list;
    image_set whole, small; // that are there
} builder;

static image_set *there(builder *b, step_size size) { return size == STEP_WHOLE || size == STEP_UP ? &b->whole : &b->small; }

static void add(builder *b, plan_step s)
{
    if (b->list->count == STEPS_MOST) return;
    s.runs = true;
    *there(b, s.size) |= s.writes;
    b->list->steps[b->list->count++] = s;
}

// ---- how they run

static bool run_pass(pass_context *c, const plan_step *s, error *e) { return s->call(c, e); }

static bool run_method(pass_context *c, const plan_step *s, error *e)
{
    c->want_bent = s->writes & BIT(BENT), c->want_error = s->writes & BIT(ERROR);
    c->want_radiance = s->writes & BIT(RADIANCE), c->want_visibility = s->writes & BIT(VISIBILITY);
    c->want_indirect = s->writes & BIT(INDIRECT);
    return s->call(c, e);
}

static gpu_image *if_written(pass_context *c, const plan_step *s, image_id id)
{
    return s->writes & IMAGE_BIT(id) ? &c->image[id] : NULL;
}

// Light that is marched for at a smaller size has few samples on a surface, so it takes a filter that is twice as wide, and
// fitted: that keeps what lies at the foot of things and along edges. Other bounces vary less along a surface than light does.
static bool run_blur(pass_context *c, const plan_step *s, error *e)
{
    bool wider = s->size != STEP_WHOLE && s->writes & BIT(INDIRECT) && c->set.blur > 0;
    pass_blurring b = {.radius = s->fitted ? 2 * c->set.blur : c->set.blur + wider,
                       .fitted = s->fitted,
                       .scalars = {if_written(c, s, IMAGE_OCCLUSION), if_written(c, s, IMAGE_VISIBILITY)}};
    static const image_id colours[] = {IMAGE_RADIANCE, IMAGE_INDIRECT, IMAGE_BENT};
    for (size_t i = 0, n = 0; i < sizeof colours / sizeof *colours; i++)
        if (s->writes & IMAGE_BIT(colours[i])) b.colours[n++] = &c->image[colours[i]];
    return pass_blur(c, &b, e);
}

static bool run_tone(pass_context *c, const plan_step *s, error *e)
{
    for (int i = 0; i < IMAGE_COUNT; i++)
        if (s->writes & IMAGE_BIT(i) && !pass_tone(c, &c->image[i], e)) return false;
    return true;
}

// ---- the method, and what is made of its layers

bool steps_split_suns(const plan *p)
{
    return method_makes(p->method, MAKES_LIGHT_WITHOUT_SUNS) && (p->want_radiance || p->want_visibility);
}

static bool has_own_bounce(const plan *p) { return p->bounce && p->estimator == p->method->bounce; }

bool steps_bounce_within(const step_facts *f)
{
    const plan *p = f->plan;
    if (!has_own_bounce(p)) return false;
    if (p->estimator->march == BOUNCE_WITH_METHOD) return true;
    if (p->estimator->march != BOUNCE_WITH_PICTURE || !(p->want_radiance || p->want_visibility)) return false;
    // Of a picture that is lit here a first estimate of the light is enough, unless all is to be exact or spheres change the
    // light.
    return !f->set->relight || (f->set->size != SIZE_FULL && !f->proxies);
}

bool steps_use_small(const plan *p, const pass_settings *set)
{
    if (set->size != SIZE_LIGHT) return set->size == SIZE_HALF;
    return p->method->run_light && (p->want_radiance || p->want_visibility || has_own_bounce(p));
}

// As run_method; the method's light of single pixels.
static bool run_refine(pass_context *c, const plan_step *s, error *e)
{
    c->at_lone = true;
    bool ok = run_method(c, s, e);
    c->at_lone = false;
    return ok;
}

static image_set vector_of(const pass_settings *set)
{
    image_set all = BIT(SH_0) | BIT(SH_1) | BIT(SH_2);
    return set->sh_bands == 3 ? all | BIT(SH_3) | BIT(SH_4) : all;
}

static image_set made_by(const step_facts *f)
{
    const plan *p = f->plan;
    image_set made = BIT(OCCLUSION);
    if (p->want_bent) made |= BIT(BENT);
    if (p->want_error) made |= BIT(ERROR);
    if (p->want_radiance || steps_split_suns(p)) made |= BIT(RADIANCE); // that march makes it beside visibility
    if (p->want_visibility && method_makes(p->method, MAKES_LIGHT)) made |= BIT(VISIBILITY);
    if (method_makes(p->method, MAKES_SH)) made |= vector_of(f->set);
    if (steps_bounce_within(f)) made |= BIT(INDIRECT);
    if (method_makes(p->method, MAKES_ERROR) && (f->set->target_error > 0.0 || arc_has_half_difference(f->set)))
        made |= BIT(HALF_DIFFERENCE);
    return made;
}

// What surfaces send: the picture that the renderer lit, or our own radiance by their albedo.
static image_set senders(const pass_settings *set) { return set->relight ? BIT(RADIANCE) | BIT(ALBEDO) : BIT(BEAUTY); }

// Beside depth and normal, for a march that makes `made`. Light that it makes itself it does not read.
static image_set read_for(const step_facts *f, image_set made)
{
    bool gathers = made & BIT(INDIRECT) && f->plan->estimator->march == BOUNCE_WITH_PICTURE;
    return BIT(DEPTH) | BIT(NORMAL) | (gathers ? senders(f->set) & ~(made & LIGHT) : 0);
}

static void add_method(builder *b, step_size size, image_set made)
{
    const step_facts *f = b->f;
    const plan *p = f->plan;
    const char *why = p->from_sh                   ? "its SH layers are read from the file"
                      : f->set->target_error > 0.0 ? "occlusion is always made, in rounds until its error is small enough"
                                                   : "occlusion is always made";
    add(b, (plan_step){.pass = p->method->name,
                       .why = why,
                       .size = size,
                       .reads = read_for(f, made),
                       .writes = made,
                       .run = run_method,
                       .call = p->method->run});
}

// What the method's march of light makes, where that march is one of its own.
static void add_method_light(builder *b, image_set made)
{
    const step_facts *f = b->f;
    if (made)
        add(b, (plan_step){.pass = "light",
                           .why = "on a quarter of the pixels",
                           .size = STEP_AMID,
                           .reads = read_for(f, made),
                           .writes = made,
                           .run = run_method,
                           .call = f->plan->method->run_light});
}

static void add_refining(builder *b, image_set made)
{
    const step_facts *f = b->f;
    if (made && f->lone)
        add(b, (plan_step){.pass = "refine",
                           .why = "light of pixels whose surface the smaller frame does not show",
                           .reads = read_for(f, made) | made,
                           .writes = made,
                           .run = run_refine,
                           .call = made & LIGHT ? f->plan->method->run_light : f->plan->estimator->run});
}

// Light of a frame of half the size that the method marches for.
static bool is_fitted(const step_facts *f, step_size size, image_set images)
{
    return size == STEP_SMALL && f->plan->method->run_light && !(images & ~(LIGHT | BIT(INDIRECT)));
}

static void add_blur(builder *b, step_size size, image_set images)
{
    images &= *there(b, size);
    if (images)
        add(b, (plan_step){.pass = "blur",
                           .why = "noise of the sample pattern",
                           .size = size,
                           .fitted = is_fitted(b->f, size, images),
                           .reads = images,
                           .writes = images,
                           .run = run_blur});
}

static void add_filters(builder *b, step_size size)
{
    bool difference = *there(b, size) & BIT(HALF_DIFFERENCE);
    if (!b->f->plan->blur) return;
    if (difference && b->f->set->target_error <= 0.0) // rounds have denoised it
        add(b, (plan_step){.pass = "denoise",
                           .why = "noise of the slices, known from their halves",
                           .size = size,
                           .reads = BIT(OCCLUSION) | BIT(HALF_DIFFERENCE),
                           .writes = BIT(OCCLUSION),
                           .run = run_pass,
                           .call = pass_denoise});
    image_set light = LIGHT | (steps_bounce_within(b->f) ? BIT(INDIRECT) : 0);
    bool apart = is_fitted(b->f, size, light); // one filter for all of them
    add_blur(b, size, (difference ? 0 : BIT(OCCLUSION)) | (apart ? 0 : LIGHT));
    if (apart) add_blur(b, size, light);
    add_blur(b, size, BIT(BENT));
}

static image_set of_groups(image_set images, unsigned groups)
{
    for (int i = 0; i < IMAGE_COUNT; i++)
        if (!(image_table[i].groups & groups)) images &= ~IMAGE_BIT(i);
    return images;
}

static void add_light(builder *b)
{
    const step_facts *f = b->f;
    const plan *p = f->plan;
    image_set *have = &b->whole, light = *have & LIGHT;
    if (f->suns)
        add(b, (plan_step){.pass = "suns",
                           .why = "small bright sources of the environment",
                           .reads = light,
                           .writes = light,
                           .run = run_pass,
                           .call = pass_suns});
    image_set blocked = of_groups(*have, IMAGE_BLOCKED | IMAGE_VECTOR);
    if (f->proxies)
        add(b, (plan_step){.pass = "proxies",
                           .why = "--proxies: spheres that the camera does not see",
                           .reads = blocked,
                           .writes = blocked,
                           .run = run_pass,
                           .call = pass_proxies});
    image_set scalars = *have & (BIT(OCCLUSION) | BIT(VISIBILITY));
    if (p->tone)
        add(b, (plan_step){.pass = "tone",
                           .why = "scale, contrast and the bounds of a scalar method",
                           .reads = scalars,
                           .writes = scalars,
                           .run = run_tone});
    if (p->irradiance)
        add(b, (plan_step){.pass = "irradiance",
                           .why = "the method gives no direction: SH irradiance x occlusion",
                           .reads = BIT(OCCLUSION),
                           .writes = BIT(RADIANCE),
                           .run = run_pass,
                           .call = pass_irradiance});
}

static void add_bounce(builder *b, step_size size)
{
    const step_facts *f = b->f;
    const plan *p = f->plan;
    if (!p->bounce) return;
    if (!steps_bounce_within(f))
        add(b, (plan_step){.pass = "bounce",
                           .why = "indirect light",
                           .size = size,
                           .reads = senders(f->set),
                           .writes = BIT(INDIRECT),
                           .run = run_pass,
                           .call = p->estimator->run});
    step_size made = size == STEP_AMID ? STEP_SMALL : size;
    bool filtered = steps_bounce_within(f) && is_fitted(f, made, BIT(INDIRECT)); // with the light
    if (f->set->blur > 0 && !p->estimator->exact && !filtered) add_blur(b, made, BIT(INDIRECT));
}

// ---- at half the size

static void add_upsampling(builder *b, image_set which)
{
    image_set images = 0;
    for (int i = 0; i < IMAGE_COUNT; i++)
        if (image_table[i].resampled != AS_NOTHING) images |= IMAGE_BIT(i) & which & b->small & ~b->whole;
    if (images)
        add(b, (plan_step){.pass = "upsample", .why = "--resolution", .size = STEP_UP, .reads = images, .writes = images});
}

// The method's light and its own bounce see the whole frame from a quarter of the pixels. All else is as at full size.
static void add_light_at_half(builder *b)
{
    const image_set light = LIGHT | BIT(INDIRECT), made = made_by(b->f);
    add_method(b, STEP_WHOLE, made & ~light);
    add_filters(b, STEP_WHOLE);
    add_method_light(b, made & light);
    add_filters(b, STEP_SMALL);
    if (made & BIT(INDIRECT)) add_bounce(b, STEP_AMID);
    add_upsampling(b, ~(image_set)0);
    add_refining(b, made & light);
    add_light(b);
    if (made & BIT(INDIRECT)) return;
    bool own = has_own_bounce(b->f->plan);
    add_bounce(b, own ? STEP_AMID : STEP_WHOLE);
    add_upsampling(b, BIT(INDIRECT));
    if (own) add_refining(b, BIT(INDIRECT));
}

// All layers go up together, unless the bounce needs what is done to the light at full size.
static void add_all_at_half(builder *b)
{
    const step_facts *f = b->f;
    const plan *p = f->plan;
    bool lit_later =
        p->bounce && f->set->relight && !steps_bounce_within(f) && (p->tone || p->irradiance || f->proxies || f->suns);
    add_method(b, STEP_SMALL, made_by(f));
    add_filters(b, STEP_SMALL);
    if (!lit_later) add_bounce(b, STEP_SMALL);
    add_upsampling(b, ~(image_set)0);
    add_light(b);
    if (!lit_later) return;
    add(b, (plan_step){.pass = "downsample",
                       .why = "the light that the bounce gathers",
                       .size = STEP_DOWN,
                       .reads = BIT(RADIANCE),
                       .writes = BIT(RADIANCE)});
    add_bounce(b, STEP_SMALL);
    add_upsampling(b, BIT(INDIRECT));
}

static void add_at_full(builder *b)
{
    add_method(b, STEP_WHOLE, made_by(b->f));
    add_filters(b, STEP_WHOLE);
    add_light(b);
    add_bounce(b, STEP_WHOLE);
}

// ---- what follows at full size

static bool to_fill(const step_facts *f) { return f->plan->edges && f->given & BIT(COVERAGE); }

// Layers with a pass of their own, where nothing but the layer needs it.
static bool asks_for_pass(const plan *p, int layer)
{
    return layer_table[layer]->pass && (p->layers & 1u << layer || (layer == LAYER_DEPTHMASK && p->depthmask));
}

static void add_composite(builder *b)
{
    const step_facts *f = b->f;
    const plan *p = f->plan;
    image_set writes = BIT(COMPOSITE), used = LIGHT | BIT(OCCLUSION) | BIT(INDIRECT) | BIT(SPECULAR) | BIT(DIFFUSE_SHARE) |
                                              BIT(DEPTHMASK) | BIT(ALBEDO) | BIT(BEAUTY) | BIT(EMISSION) | BIT(DIFFUSE_DIRECT) |
                                              BIT(COVERAGE);
    if (p->layers & 1u << LAYER_DIFFUSE) writes |= BIT(DIFFUSE);
    add(b, (plan_step){.pass = "composite",
                       .why = p->relight ? "lit by us" : "the beauty, occluded",
                       .reads = b->whole & used,
                       .writes = writes,
                       .run = run_pass,
                       .call = pass_composite});
}

static void add_rest(builder *b)
{
    const step_facts *f = b->f;
    const plan *p = f->plan;
    // A beauty's light on unseen spheres is unknown: they send none.
    if (p->bounce && f->set->relight && f->proxies)
        add(b, (plan_step){.pass = "proxies bounce",
                           .why = "light from the spheres",
                           .reads = BIT(INDIRECT),
                           .writes = BIT(INDIRECT),
                           .run = run_pass,
                           .call = pass_proxies_bounce});
    image_set filled = of_groups(b->whole, IMAGE_FILLED | IMAGE_VECTOR);
    image_set mixed = pass_mix_takes(b->whole);
    if (f->mixed)
        add(b, (plan_step){.pass = "mix",
                           .why = "pixels whose normal is a mean of two surfaces'",
                           .reads = mixed,
                           .writes = mixed,
                           .run = run_pass,
                           .call = pass_mix});
    if (to_fill(f))
        add(b, (plan_step){.pass = "edges",
                           .why = "partly covered pixels",
                           .reads = filled | BIT(COVERAGE),
                           .writes = filled,
                           .run = run_pass,
                           .call = pass_edges});
    if (p->specular)
        add(b, (plan_step){.pass = "specular",
                           .why = "roughness and environment",
                           .reads = BIT(MATERIAL),
                           .writes = BIT(SPECULAR) | BIT(DIFFUSE_SHARE),
                           .run = run_pass,
                           .call = pass_specular});
    for (int i = 0; i < LAYER_COUNT; i++)
        if (asks_for_pass(p, i))
            add(b, (plan_step){.pass = layer_table[i]->name,
                               .why = p->layers & 1u << i ? "the layer is asked for" : "the composite",
                               .reads = BIT(DEPTH),
                               .writes = IMAGE_BIT(layer_table[i]->image),
                               .run = run_pass,
                               .call = layer_table[i]->pass});
    if (p->composite) add_composite(b);
}

// ---- what does not run

static void add_missing(step_list *l, const char *pass, const char *why)
{
    for (int i = 0; i < l->count; i++)
        if (strcmp(l->steps[i].pass, pass) == 0) return;
    if (l->count < STEPS_MOST) l->steps[l->count++] = (plan_step){.pass = pass, .why = why};
}

static void list_missing(const step_facts *f, step_list *l)
{
    const plan *p = f->plan;
    bool light = method_makes(p->method, MAKES_LIGHT);
    add_missing(l, "irradiance", light ? "the method makes radiance itself" : "no layer needs light");
    add_missing(l, "blur",
                method_makes(p->method, MAKES_SH) ? "the method filters itself"
                : p->blur                         ? "the occlusion is denoised, and nothing else was sampled"
                                                  : "--blur none");
    add_missing(l, "denoise", p->blur && f->set->target_error > 0.0 ? "part of the rounds" : "too few slices, or none");
    add_missing(l, "suns", "no light, or none of small bright sources");
    add_missing(l, "proxies", "no spheres are given");
    add_missing(l, "tone", "scale and contrast are 1");
    add_missing(l, "bounce", p->bounce ? "the method's own march makes it" : p->why_no_bounce);
    add_missing(l, "light", light ? "made beside the occlusion, or not needed" : "the method has no march of light");
    add_missing(l, "refine", "no light is made at half size, or it shows the surface of every pixel");
    add_missing(l, "upsample", "all is made at full size");
    add_missing(l, "downsample", "nothing at half size needs what is made at full size");
    add_missing(l, "mix", "no pixel has a mean of two surfaces' normals that tells how much of each it holds");
    add_missing(l, "edges", "every pixel with a share of a surface has one recorded");
    add_missing(l, "specular", p->why_no_specular);
    for (int i = 0; i < LAYER_COUNT; i++)
        if (layer_table[i]->pass) add_missing(l, layer_table[i]->name, "no layer needs it");
    add_missing(l, "composite", "no layer needs it");
}

// ---- the list

image_set steps_given(const gbuffer *gb)
{
    image_set given = 0;
    for (int i = 0; i < IMAGE_COUNT; i++)
        if (image_table[i].given && pass_pixels(gb, (image_id)i)) given |= IMAGE_BIT(i);
    return given;
}

// Colours are looked at only by a bounce that gathers at half size.
image_set steps_given_small(const plan *p, const pass_settings *set, image_set given)
{
    image_set looked_at = BIT(DEPTH) | BIT(NORMAL);
    bool gathers = p->bounce && set->size == SIZE_HALF;
    if (gathers) looked_at |= BIT(ALBEDO);
    if (gathers && !set->relight) looked_at |= BIT(BEAUTY);
    return given & looked_at;
}

void steps_make(const step_facts *f, step_list *out)
{
    out->count = 0;
    builder b = {.f = f, .list = out, .whole = f->given};
    if (steps_use_small(f->plan, f->set)) {
        b.small = steps_given_small(f->plan, f->set, f->given);
        (f->set->size == SIZE_LIGHT ? add_light_at_half : add_all_at_half)(&b);
    } else {
        add_at_full(&b);
    }
    add_rest(&b);
    list_missing(f, out);
}
