#include "passes/arc.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "passes/further.h"
#include "passes/method.h"
#include "passes/openings.h"
#include "passes/surround_image.h"

static const float HUGE_LENGTH = 1e15f; // its square is still a float
static const float KAPPA = 1.0f;        // a run is as thick as it is wide
// How far a run may turn between two steps: the tangent of 52 degrees, or of 65 degrees where a march within the radius has many
// short steps.
static const float TOLERANCE = 1.3f, SHORT_STEP_TOLERANCE = 2.1f;

// With this many slices or more, half of them resemble the whole set, so the change by the other half measures the noise.
enum { LEAST_FOR_HALF_DIFFERENCE = 4 };

// The filter averages the slices of neighbouring pixels, but it cannot find what the steps have missed. So small budgets go into
// steps: 1 x 8, 1 x 16 and 2 x 16 (slices x steps a side). Large budgets need no filter and take about twice as many steps as
// slices.
void arc_grid(int samples, int *slices, int *steps)
{
    double most = fmin(samples / 32.0, sqrt(samples / 4.0));
    int s = (int)lround(most);
    if (s >= LEAST_FOR_HALF_DIFFERENCE) s = 2 * (int)lround(0.5 * most); // two halves
    *slices = s > 1 ? s : 1;
    *steps = samples / (2 * *slices) > 1 ? samples / (2 * *slices) : 1;
}

bool arc_has_half_difference(const pass_settings *set)
{
    int slices, steps;
    arc_grid(set->samples, &slices, &steps);
    return slices >= LEAST_FOR_HALF_DIFFERENCE && set->blur > 0;
}

void arc_set_grid(arc_params *p, int slices, int steps)
{
    p->slices = slices, p->steps = steps;
    p->inverse_steps = 1.0f / (float)steps;
}

arc_params arc_params_of_grid(const pass_context *c, int slices, int steps)
{
    const pass_settings *s = &c->set;
    arc_params p = {
        .radius = (float)s->radius,
        .thickness = isinf(s->thickness) ? HUGE_LENGTH : (float)s->thickness,
        .kappa = s->thickness_fixed ? 0.0f : KAPPA,
        .seed = s->seed,
        .planes = c->planes.count,
        .level = (float)s->env_level,
        .strength = (float)s->bounce_strength,
        .sun_openness = (float)s->outside.suns,
    };
    for (int i = 0; i < OPENNESS_COUNT; i++) p.openness[i / 4][i % 4] = (float)s->outside.share[i];
    params_put(p.walls_low, v3_sub(s->outside.low, s->upright_eye), 0);
    params_put(p.walls_high, v3_sub(s->outside.high, s->upright_eye), 0);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) p.upright_from_camera[i][k] = (float)s->upright_from_camera.m[i][k];
    further_put(c, &p);
    surround_image_put(c, &p);
    if (s->thickness_fixed) p.thin = p.thickness;
    arc_set_grid(&p, slices, steps);
    p.tolerance =
        fmaxf(TOLERANCE, fminf(SHORT_STEP_TOLERANCE, 0.5f + 0.1f * (float)p.steps)); // 8 steps a side are long, 16 short
    return p;
}

arc_params arc_params_of(const pass_context *c)
{
    int slices, steps;
    arc_grid(c->set.samples, &slices, &steps);
    return arc_params_of_grid(c, slices, steps);
}

arc_params arc_unlimited_params_of(const pass_context *c)
{
    arc_params p = arc_params_of(c);
    p.radius = HUGE_LENGTH;
    for (int i = 0; i < HIDDEN_SH; i++)
        for (int k = 0; k < 3; k++) p.hidden[i][k] = (float)c->hidden[i][k];
    // Uneven ground stands in for light only. Within the radius runs find better what it hides.
    p.planes = c->planes.count + c->planes.uneven;
    p.tolerance = TOLERANCE;
    return p;
}

// ---- planes

_Static_assert(PLANE_COLUMNS == PLANE_MASK + PLANE_CELLS / 4 && MAX_SUNS == SUNS_MAX, "shaders/include/constants.glsl");

// Which of 32 sectors a plane may block: the share that it is believed by, spread evenly.
static uint32_t believed_sectors(double belief)
{
    uint32_t mask = 0;
    for (int k = 0; k < 32; k++) {
        int turned = (k & 1) << 4 | (k & 2) << 2 | (k & 4) | (k & 8) >> 2 | (k & 16) >> 4; // the five bits in reverse
        if (turned < lround(32.0 * belief)) mask |= 1u << k;
    }
    return mask;
}

static void put_plane(float row[PLANE_COLUMNS][4], const plane *p, bool uneven)
{
    params_put(row[PLANE_EQUATION], p->normal, p->offset);
    for (int i = 0; i < 2; i++)
        params_put(row[PLANE_U + i], v3_scale(p->axis[i], 1.0 / p->extent[i]), p->centre[i] / p->extent[i]);
    params_put(row[PLANE_LIGHT], v3(0, 0, 0), uneven ? -p->margin : p->margin);
    uint32_t sectors = believed_sectors(p->belief);
    params_put(row[PLANE_BELIEF], v3(p->belief, sectors & 0xffff, sectors >> 16), 0);
    for (int y = 0; y < PLANE_CELLS; y++) row[PLANE_MASK + y / 4][y % 4] = (float)p->cells[y];
}

// Finds the planes, once a frame, and puts them where the shader reads them.
static bool make_planes(pass_context *c, error *e)
{
    if (!c->set.planes || c->image[IMAGE_PLANES].id) return true;
    if (!c->planes.found && !planes_find(c->gb, &c->planes, e)) return false;
    float rows[PLANES_MAX + 1][PLANE_COLUMNS][4] = {0};
    for (int i = 0; i < c->planes.count + c->planes.uneven; i++) put_plane(rows[i], &c->planes.planes[i], i == c->planes.count);
    for (int i = 0; i < c->planes.count + c->planes.uneven; i++)
        log_info(c->log, "%s %d: %.1f %% of the surfaces, %.3g x %.3g scene units",
                 i == c->planes.count ? "uneven ground, as plane" : "plane", i + 1, 100.0 * c->planes.planes[i].share,
                 2.0 * c->planes.planes[i].extent[0], 2.0 * c->planes.planes[i].extent[1]);
    if (!gpu_image_make(c->g, &c->image[IMAGE_PLANES], GL_RGBA32F, PLANE_COLUMNS, PLANES_MAX + 1, 1, e)) return false;
    gpu_image_upload(c->g, &c->image[IMAGE_PLANES], 0, rows[0][0]);
    return true;
}

// ---- the outside

bool arc_has_surround(const pass_context *c) { return c->view_count > 0; }

bool arc_closes_outside(const pass_context *c) { return !openness_is_whole(&c->set.outside) || arc_has_surround(c); }

static bool make_rim(pass_context *c, error *e)
{
    gpu_image *to = &c->image[IMAGE_RIM];
    if (!arc_closes_outside(c) || to->id) return true;
    float *rim = mem_pixels((size_t)c->width * (size_t)c->height, sizeof *rim, e);
    bool ok = rim && openings_find(c->gb, rim, e) && pass_make_image(c, IMAGE_RIM, e);
    if (ok) gpu_image_upload(c->g, to, 0, rim);
    free(rim);
    return ok;
}

// ---- the passes

variant arc_occlusion_variant(const pass_context *c, const char *blocked)
{
    variant v = arc_variant(c, blocked);
    variant_add(&v, strcmp(blocked, "RUNS") == 0 && further_serves(c), "FURTHER");
    return v;
}

variant arc_variant(const pass_context *c, const char *what)
{
    variant v = {{0}};
    variant_add(&v, *what != 0, what);
    variant_add(&v, c->planes.count + c->planes.uneven > 0, "PLANES");
    return v;
}

static bool make_surface(pass_context *c, error *e)
{
    if (c->image[IMAGE_SURFACE].id) return true;
    const arc_params params = arc_params_of(c);
    const variant v = arc_variant(c, "");
    const pass_call call = {
        .program = "surface",
        .variant = v.words,
        PASS_PARAMS(params),
        .reads = {{"planes_image", &c->image[IMAGE_PLANES]}},
        .writes = {{"surface_image", &c->image[IMAGE_SURFACE]}},
    };
    return pass_make_image(c, IMAGE_SURFACE, e) && pass_run(c, &call, e);
}

bool arc_make_inputs(pass_context *c, error *e) { return make_planes(c, e) && make_surface(c, e) && further_make(c, e); }

bool arc_make_outside(pass_context *c, error *e) { return make_rim(c, e) && (!arc_has_surround(c) || surround_image_make(c, e)); }

// Bent normals after the rounds: as many slices as each tile came to. The occlusion that this march makes is not used.
static bool run_bent(pass_context *c, const char *what, error *e)
{
    const arc_params params = arc_params_of_grid(c, ROUND_SLICES, ROUND_STEPS);
    variant v = arc_occlusion_variant(c, what);
    gpu_image unused = {0};
    variant_add(&v, true, "BENT");
    const pass_call call = {
        .program = "arc_occlusion",
        .label = "arc bent",
        .variant = v.words,
        .reads = {{"surface_image", &c->image[IMAGE_SURFACE]},
                  {"planes_image", &c->image[IMAGE_PLANES]},
                  {"further_image", c->further}},
        .writes = {{"occlusion_image", &unused}, {"bent_image", &c->image[IMAGE_BENT]}},
    };
    bool ok =
        pass_make(c, &unused, GL_R32F, 1.0f, e) && pass_make_image(c, IMAGE_BENT, e) && arc_run_as_adaptive(c, &call, &params, e);
    gpu_image_free(&unused);
    return ok;
}

bool arc_run_occlusion(pass_context *c, const char *what, error *e)
{
    if (c->set.target_error > 0.0) return arc_run_adaptive(c, what, e) && (!c->want_bent || run_bent(c, what, e));
    const arc_params params = arc_params_of(c);
    bool half_difference = arc_has_half_difference(&c->set);
    variant v = arc_occlusion_variant(c, what);
    variant_add(&v, c->want_bent, "BENT");
    variant_add(&v, half_difference, "HALF_DIFFERENCE");
    if (!pass_make_image(c, IMAGE_OCCLUSION, e)) return false;
    if (c->want_bent && !pass_make_image(c, IMAGE_BENT, e)) return false;
    if (half_difference && !pass_make_image(c, IMAGE_HALF_DIFFERENCE, e)) return false;
    const pass_call call = {
        .program = "arc_occlusion",
        .label = "arc",
        .variant = v.words,
        PASS_PARAMS(params),
        .reads = {{"surface_image", &c->image[IMAGE_SURFACE]},
                  {"planes_image", &c->image[IMAGE_PLANES]},
                  {"further_image", c->further}},
        .writes = {{"occlusion_image", &c->image[IMAGE_OCCLUSION]},
                   {"bent_image", &c->image[IMAGE_BENT]},
                   {"half_difference_image", &c->image[IMAGE_HALF_DIFFERENCE]}},
    };
    return pass_run(c, &call, e);
}

// What the planes send: one work group that reads the whole frame's grid.
static bool light_planes(pass_context *c, const arc_params *params, const gpu_image *sender, const gpu_image *albedo, error *e)
{
    const pass_call call = {
        .program = "plane_light",
        .untimed = true,
        .groups = {1, 1},
        PASS_PARAMS(*params),
        .reads = {{"sender_image", sender}, {"albedo_image", albedo}},
        .writes = {{"planes_image", &c->image[IMAGE_PLANES]}},
    };
    return c->planes.count + c->planes.uneven == 0 || pass_run(c, &call, e);
}

// What surfaces outside the frame send.
static bool light_outside(pass_context *c, const arc_params *params, const gpu_image *sender, const gpu_image *albedo, error *e)
{
    const pass_call call = {
        .program = "outside_light",
        .untimed = true,
        .groups = {1, 1},
        PASS_PARAMS(*params),
        .reads = {{"sender_image", sender}, {"albedo_image", albedo}},
        .writes = {{"outside_image", &c->image[IMAGE_OUTSIDE_LIGHT]}},
    };
    if (!arc_closes_outside(c)) return true;
    if (!c->image[IMAGE_OUTSIDE_LIGHT].id && !gpu_image_make(c->g, &c->image[IMAGE_OUTSIDE_LIGHT], GL_RGBA32F, 2, 1, 1, e))
        return false;
    return pass_run(c, &call, e);
}

static bool make_senders(pass_context *c, const gpu_image *sender, const gpu_image *albedo, error *e)
{
    if (c->image[IMAGE_SENDERS].id) return true; // for the march at the small pixels
    const pass_call call = {
        .program = "senders",
        .variant = sender != albedo ? "ALBEDO" : NULL,
        .reads = {{"surface_image", &c->image[IMAGE_SURFACE]}, {"sender_image", sender}, {"albedo_image", albedo}},
        .writes = {{"senders_image", &c->image[IMAGE_SENDERS]}},
    };
    return pass_make_image(c, IMAGE_SENDERS, e) && pass_run(c, &call, e);
}

static bool find_hidden_light(pass_context *c, error *e)
{
    // Where further G-buffers show what is around, the guess of how open the unseen is does not hold.
    const openness open = openness_even(1.0);
    const pass_settings *s = &c->set;
    const hidden_place at = {.gb = c->gb,
                             .planes = &c->planes,
                             .outside = arc_has_surround(c) ? &open : &s->outside,
                             .map_from_camera = m3_mul(c->env->map_from_world, s->world_from_camera),
                             .upright_from_camera = s->upright_from_camera,
                             .upright_eye = s->upright_eye};
    if (c->hidden_found) return true;
    c->hidden_found = hidden_light(c->env, &at, c->threads, c->hidden, e);
    return c->hidden_found;
}

// Light comes from any distance, so this march has no radius. It makes the sky's light, through the open sectors, and the bounce,
// from the blocked ones. One march makes both, unless the bounce gathers the filtered sky light itself.
//
// On a smaller frame the pixels are the receivers; what blocks and sends light is the whole frame.
bool arc_run_light(pass_context *c, const arc_light *what, error *e)
{
    const bool sky = what->sky, bounce = what->bounce, visibility = sky && what->visibility;
    pass_context *seen = c->whole ? c->whole : c;
    // A beauty is the light that surfaces send. Our own radiance is light before albedo.
    bool exitant = !c->set.relight;
    const gpu_image *sender = &seen->image[exitant ? IMAGE_BEAUTY
                                           : sky   ? IMAGE_FIRST_LIGHT
                                                   : IMAGE_RADIANCE],
                    *albedo = &seen->image[exitant ? IMAGE_BEAUTY : IMAGE_ALBEDO];
    if (!arc_make_inputs(seen, e) || !arc_make_outside(seen, e) || (sky && bounce && !exitant && !arc_first_light(c, e)))
        return false;
    if (bounce && !exitant && !find_hidden_light(seen, e)) return false;
    arc_params params = arc_unlimited_params_of(seen);
    int slices, steps;
    arc_grid(c->set.samples, &slices, &steps);
    arc_set_grid(&params, slices, steps);
    params.exitant = exitant;
    params.side = c->whole_side;
    if (sky && (!pass_split_suns(c, e) || !pass_make_image(c, IMAGE_RADIANCE, e))) return false;
    if (visibility && !pass_make_image(c, IMAGE_VISIBILITY, e)) return false;
    if (bounce && !exitant && arc_has_surround(c) && !surround_image_light(c, e)) return false;
    if (bounce && (!light_planes(seen, &params, sender, albedo, e) || !light_outside(seen, &params, sender, albedo, e) ||
                   !make_senders(seen, sender, albedo, e) || !pass_make_image(c, IMAGE_INDIRECT, e)))
        return false;
    if (sky) c->suns_pending = c->sunless->map.id != 0;
    variant v = arc_variant(seen, "");
    variant_add(&v, visibility, "VISIBILITY");
    variant_add(&v, sky && bounce, "BOUNCE");
    variant_add(&v, bounce && exitant, "EXITANT");
    variant_add(&v, arc_closes_outside(c), "OUTSIDE");
    variant_add(&v, arc_has_surround(c), "SURROUND");
    variant_add(&v, c->whole != NULL, "RECEIVERS");
    variant_add(&v, what->lone != NULL, "LONE");
    pass_call call = {
        .program = sky ? "arc_light" : "arc_bounce",
        .label = sky && bounce ? "arc light+bounce"
                 : sky         ? "arc light"
                               : "arc bounce",
        .variant = v.words,
        .seen = seen,
        .environment = sky && c->suns_pending ? &c->sunless->map : NULL,
        .reads = {{"surface_image", &seen->image[bounce ? IMAGE_SENDERS : IMAGE_SURFACE]},
                  {"planes_image", &seen->image[IMAGE_PLANES]},
                  {"sender_image", sender},
                  {"outside_image", &seen->image[IMAGE_OUTSIDE_LIGHT]},
                  {"rim_image", &seen->image[IMAGE_RIM]},
                  {"surround_image", &seen->surround->shell},
                  {"surround_light_image", &seen->surround->light},
                  {"receiver_depth", &c->image[IMAGE_DEPTH]},
                  {"receiver_normal", &c->image[IMAGE_NORMAL]}},
        .writes = {{"visibility_image", &c->image[IMAGE_VISIBILITY]},
                   {"radiance_image", &c->image[IMAGE_RADIANCE]},
                   {"indirect_image", &c->image[IMAGE_INDIRECT]}},
    };
    if (!what->lone) return arc_run_as_adaptive(c, &call, &params, e);
    call.params = &params, call.params_size = sizeof params;
    return pass_at_lone(c, what->lone, &call,
                        (sky ? IMAGE_BIT(IMAGE_RADIANCE) : 0) | (visibility ? IMAGE_BIT(IMAGE_VISIBILITY) : 0) |
                            (bounce ? IMAGE_BIT(IMAGE_INDIRECT) : 0),
                        e);
}

// Of what a step asks for.
static arc_light asked(const pass_context *c, bool sky, bool bounce)
{
    return (arc_light){.sky = sky, .bounce = bounce, .visibility = c->want_visibility, .lone = c->at_lone ? c->lone : NULL};
}

static bool light(pass_context *c, error *e)
{
    const arc_light what = asked(c, true, c->want_indirect);
    return arc_run_light(c, &what, e);
}

static bool run(pass_context *c, error *e)
{
    if (!arc_make_inputs(c, e) || !arc_run_occlusion(c, "RUNS", e)) return false;
    return !(c->want_radiance || c->want_visibility) || light(c, e);
}

static bool run_bounce(pass_context *c, error *e)
{
    const arc_light what = asked(c, false, true);
    return (c->image[IMAGE_INDIRECT].id && !what.lone) || arc_run_light(c, &what, e);
}

// Of marches for light: what they know beyond the frame, and of which pixels.
#define ARC_FRAME "[OUTSIDE] [SURROUND] [RECEIVERS] [LONE]"

static const variant_row variants[] = {
    {.program = "arc_bounce", .pattern = "[PLANES] [EXITANT] " ARC_FRAME},
    {.program = "arc_light",
     .pattern = "[PLANES] [VISIBILITY] " ARC_FRAME " | [PLANES] [VISIBILITY] BOUNCE [EXITANT] " ARC_FRAME},
    {.program = "arc_occlusion", .pattern = ARC_OCCLUSION("RUNS [PLANES] [FURTHER]")},
    {.program = "outside_light", .pattern = ""},
    {.program = "plane_light", .pattern = ""},
    {.program = "senders", .pattern = "[ALBEDO]"},
    {.program = "suns", .pattern = "[OUTSIDE] [SURROUND]"},
    {.program = "suns_add", .pattern = "[VISIBILITY]"},
    {.program = "surface", .pattern = "[PLANES]"},
    {.program = "surround_light", .pattern = ""},
    {0},
};

const bounce_kind bounce_arc = {
    .name = "arc",
    .source = SEES_PICTURE,
    .march = BOUNCE_WITH_PICTURE,
    .run = run_bounce,
};

const method method_arc = {
    .name = "arc",
    .summary =
        "arcs that connected surfaces block in slices around the view vector; planes of the picture stand in for what is hidden",
    .weighting = "cosine, in slices around the view vector",
    .reaches = "surfaces within the radius; for light and bounce at any distance",
    .blind = "what neither the camera sees nor a large visible plane continues; how deep a body is, is guessed from its width",
    .light = "environment, sun shadows and one bounce by the same march",
    .choose = "always, unless a look must be matched",
    .options = "error thickness planes",
    .samples = 64,
    .blur = 4,
    .thickness = 0.15,
    .makes = MAKES_LIGHT | MAKES_LIGHT_WITHOUT_SUNS | MAKES_BENT | MAKES_ERROR,
    .source = SEES_PICTURE,
    .weight = WEIGHS_COSINE,
    .reach = REACH_SURFACES,
    .bounce = &bounce_arc,
    .variants = variants,
    .run = run,
    .run_light = light,
};
