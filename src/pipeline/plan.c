#include "pipeline/plan.h"

#include <stdio.h>
#include <string.h>

#include "gbuffer/conventions.h"
#include "gbuffer/gbuffer.h"

typedef struct inputs {
    bool env, averaged, albedo, beauty, roughness, emission, diffuse_direct, diffuse_indirect;
} inputs;

static inputs inputs_of(const options *o, const resolution *r)
{
    return (inputs){
        .env = o->env != NULL,
        .averaged = convention_named(r->convention)->normals_averaged,
        .albedo = r->components[ROLE_ALBEDO] > 0,
        .beauty = r->components[ROLE_BEAUTY] > 0,
        .roughness = r->components[ROLE_ROUGHNESS] > 0,
        .emission = r->components[ROLE_EMISSION] > 0,
        .diffuse_direct = r->components[ROLE_DIFFUSE_DIRECT] > 0,
        .diffuse_indirect = r->components[ROLE_DIFFUSE_INDIRECT] > 0,
    };
}

static bool asked(const plan *p, layer_id l) { return p->layers & 1u << l; }

// Drops a layer that cannot be made, or refuses when it was asked for by name.
static bool cannot(plan *p, const options *o, const exrio_file *file, layer_id l, const char *channel, const char *because,
                   log_t *log, error *e)
{
    if (!asked(p, l)) return true;
    const char *name = layer_table[l]->name;
    if (o->layers) return err_set(e, ERR_INPUT, file->path, channel, "layer '%s' cannot be made: %s", name, because);
    p->layers &= ~(1u << l);
    log_warn(log, name, "layer '%s' is left out: %s", name, because);
    return true;
}

// The mesh brings its own albedo and light: the picture's is not asked for.
static bool traces_bounce(const plan *p) { return p->estimator && p->estimator->source == SEES_MESH; }

static bool find_bounce(plan *p, const options *o, error *e)
{
    char all[METHOD_NAMES];
    p->estimator = o->bounce ? bounce_find(o->bounce) : p->method->bounce;
    if (p->estimator || !o->bounce || strcmp(o->bounce, "none") == 0) return true;
    bounce_names(all, sizeof all, ", ");
    return err_set(e, ERR_USAGE, NULL, NULL, "--bounce: there is no bounce '%s'; the bounces are none, %s", o->bounce, all);
}

// Of layers that only some methods make.
static bool drop_products(plan *p, const options *o, const exrio_file *file, log_t *log, error *e)
{
    static const struct {
        method_product product;
        layer_id first, last;
    } rows[] = {{MAKES_BENT, LAYER_BENT, LAYER_BENT}, {MAKES_SH, LAYER_SH_0, LAYER_SH_3}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char makers[METHOD_NAMES], because[METHOD_NAMES + 32];
        if (method_makes(p->method, rows[i].product)) continue;
        method_names(makers, sizeof makers, rows[i].product, ", ", " or ");
        snprintf(because, sizeof because, "it takes --method %s", makers);
        for (int l = (int)rows[i].first; l <= (int)rows[i].last; l++)
            if (!cannot(p, o, file, (layer_id)l, NULL, because, log, e)) return false;
    }
    return true;
}

static bool drop_impossible(plan *p, const options *o, const exrio_file *file, const inputs *in, log_t *log, error *e)
{
    const char *no_bounce = o->bounce ? "--bounce none" : "this method has no bounce of its own; --bounce ssdo or vpl adds one";
    if (!p->estimator && !cannot(p, o, file, LAYER_INDIRECT, NULL, no_bounce, log, e)) return false;
    const char *no_albedo = "no albedo channel was found; name it with --albedo";
    if (p->relight && !in->albedo &&
        !((traces_bounce(p) || cannot(p, o, file, LAYER_INDIRECT, "albedo", no_albedo, log, e)) &&
          cannot(p, o, file, LAYER_COMPOSITE, "albedo", no_albedo, log, e) &&
          cannot(p, o, file, LAYER_DIFFUSE, "albedo", no_albedo, log, e)))
        return false;
    if (!drop_products(p, o, file, log, e)) return false;
    if (o->sh_bands != 3 && !cannot(p, o, file, LAYER_SH_3, NULL, "it needs --sh-bands 3", log, e)) return false;
    if (o->error <= 0.0 && !cannot(p, o, file, LAYER_ERROR, NULL, "it needs --error E", log, e)) return false;
    if (!in->roughness &&
        !cannot(p, o, file, LAYER_SPECULAR, "roughness", "no roughness channel was found; name it with --roughness", log, e))
        return false;
    if (!p->relight &&
        !cannot(p, o, file, LAYER_DIFFUSE, NULL, "the beauty is not relit; give an environment with --env", log, e))
        return false;
    if (!in->env && !cannot(p, o, file, LAYER_SPECULAR, NULL, "there is no environment to reflect; give one with --env", log, e))
        return false;
    return true;
}

// The bounce goes into a beauty only where it does not already hold one.
static bool bounce_belongs(const plan *p, const options *o, const inputs *in, log_t *log)
{
    if (p->relight) return true;
    if (traces_bounce(p)) return false; // it is light of the environment, of which the beauty knows nothing
    if (!in->albedo) return false;
    if (in->diffuse_direct) return !in->diffuse_indirect;
    if (!o->bounce || !p->estimator) return false;
    log_warn(log, "double-bounce", "the beauty may already hold indirect light and occlusion; --bounce adds to it all the same");
    return true;
}

// What --error cannot be with.
static bool check_adaptive(const method *m, const options *o, error *e)
{
    if (o->error <= 0.0) return true;
    char able[METHOD_NAMES];
    method_names(able, sizeof able, MAKES_ERROR, ", ", " and ");
    if (!method_makes(m, MAKES_ERROR))
        return err_set(e, ERR_USAGE, NULL, NULL, "--error works with the methods %s, not with %s; give it a number of --samples",
                       able, m->name);
    if (o->resolution > RESOLUTION_FULL)
        return err_set(e, ERR_USAGE, NULL, NULL, "--error works at full resolution; leave --resolution or --error away");
    if (o->samples > 0 && o->samples < ROUNDS_LEAST_SAMPLES)
        return err_set(e, ERR_USAGE, NULL, NULL, "--samples must be at least %d with --error, which starts with as many",
                       ROUNDS_LEAST_SAMPLES);
    return true;
}

bool plan_asks_outside(const options *o)
{
    return o->outside < 0.0 && (o->env || o->beauty_env) && (!o->method || strcmp(o->method, method_default()->name) == 0);
}

// Why the picture's own light says nothing of the outside; NULL: it does.
static const char *why_not_fitted(const options *o, const plan *p, const inputs *in)
{
    if (o->outside >= 0.0) return "--outside says how open the outside is";
    if (!plan_asks_outside(o)) return "only --method arc asks what lies outside the frame";
    if (!p->want_radiance) return "no layer needs light";
    if (!in->diffuse_direct && !(in->beauty && in->albedo))
        return "the file has neither direct diffuse light nor a beauty with albedo";
    return NULL;
}

bool plan_make(const options *o, const exrio_file *file, const resolution *r, plan *p, log_t *log, error *e)
{
    const char *name = o->from_sh ? "s3ho" : o->method ? o->method : method_default()->name;
    char all[METHOD_NAMES];
    *p = (plan){.method = method_find(name), .from_sh = o->from_sh};
    method_names(all, sizeof all, 0, ", ", ", ");
    if (!p->method)
        return err_set(e, ERR_USAGE, NULL, NULL, "--method: there is no method '%s'; the methods are %s", o->method, all);
    if (p->method->source == SEES_MESH && !o->mesh)
        return err_set(e, ERR_USAGE, NULL, NULL, "--method %s needs the scene's surfaces; name them with --mesh FILE.obj", name);
    if (o->mesh && p->method->source != SEES_MESH) log_warn(log, "mesh", "--mesh is not used: only --method raytrace does");
    if (!find_bounce(p, o, e) || !check_adaptive(p->method, o, e) || !layers_parse(o->layers, &p->layers, e)) return false;
    inputs in = inputs_of(o, r);
    p->relight = in.env || !in.beauty;
    if (!drop_impossible(p, o, file, &in, log, e)) return false;

    p->composite = asked(p, LAYER_COMPOSITE) || asked(p, LAYER_DIFFUSE);
    p->visibility_mode = o->mode == MODE_VISIBILITY;
    p->bounce_in_composite = p->composite && p->estimator && bounce_belongs(p, o, &in, log);
    p->bounce = asked(p, LAYER_INDIRECT) || p->bounce_in_composite;
    bool relit = p->composite && p->relight;
    bool light = asked(p, LAYER_RADIANCE) || (relit && !p->visibility_mode) || (p->bounce && p->relight);
    p->want_radiance = light && method_makes(p->method, MAKES_LIGHT);
    p->want_visibility = asked(p, LAYER_VISIBILITY) || (relit && p->visibility_mode);
    p->want_bent = asked(p, LAYER_BENT);
    p->want_error = asked(p, LAYER_ERROR);
    p->irradiance = light && !method_makes(p->method, MAKES_LIGHT);
    p->specular = in.roughness && in.env && (relit || asked(p, LAYER_SPECULAR));
    p->light = light || (p->bounce && traces_bounce(p)) || p->want_visibility || p->specular;
    p->blur = (o->blur < 0 ? p->method->blur : o->blur) > 0 && !method_makes(p->method, MAKES_SH);
    p->tone = o->contrast != 1.0 || o->scale != 1.0 || !method_makes(p->method, MAKES_LIGHT);
    p->edges = true;
    p->depthmask = asked(p, LAYER_DEPTHMASK) || (p->composite && o->depthmask_strength > 0.0);

    p->need = NEED_COVERAGE;
    // Where a pixel holds two surfaces, their light is mixed by what each reflects.
    if (in.albedo && (p->bounce || p->composite || (light && in.averaged))) p->need |= NEED_ALBEDO;
    if (in.beauty && !p->relight && (p->composite || p->bounce)) p->need |= NEED_BEAUTY;
    if (in.beauty && p->relight && p->composite) p->need |= NEED_BACKGROUND;
    if (p->specular) p->need |= NEED_MATERIAL;
    if (in.emission && relit) p->need |= NEED_EMISSION;
    if (in.diffuse_direct && p->composite && !p->relight) p->need |= NEED_DIFFUSE_LIGHT;
    const char *unused = why_not_fitted(o, p, &in);
    if (!unused) p->need_to_fit = in.diffuse_direct ? NEED_DIFFUSE_LIGHT : NEED_ALBEDO | NEED_BEAUTY | NEED_EMISSION;
    if (unused && o->beauty_env) log_warn(log, "beauty-env", "--beauty-env is not used: %s", unused);
    p->why_no_bounce = !in.albedo && p->relight ? "no albedo" : "no layer needs it";
    p->why_no_specular = !in.roughness ? "no roughness" : !in.env ? "no environment" : "no layer needs it";
    return true;
}
