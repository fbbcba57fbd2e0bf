// The plan: which layers can be made and which passes run, over every method, every layer and every set of inputs.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "must.h"
#include "pipeline/plan.h"

// What the file and the command line bring.
enum { ALBEDO = 1, BEAUTY = 2, ROUGHNESS = 4, EMISSION = 8, DIRECT = 16, INDIRECT = 32, ENV = 64, SETS = 128 };

static char path[] = "in.exr";
static exrio_file file = {.path = path};

static resolution resolution_of(unsigned inputs)
{
    resolution r = {.components = {[ROLE_POSITION] = 3, [ROLE_NORMAL] = 3}};
    if (inputs & ALBEDO) r.components[ROLE_ALBEDO] = 3;
    if (inputs & BEAUTY) r.components[ROLE_BEAUTY] = 3;
    if (inputs & ROUGHNESS) r.components[ROLE_ROUGHNESS] = 1;
    if (inputs & EMISSION) r.components[ROLE_EMISSION] = 3;
    if (inputs & DIRECT) r.components[ROLE_DIFFUSE_DIRECT] = 3;
    if (inputs & INDIRECT) r.components[ROLE_DIFFUSE_INDIRECT] = 3;
    return r;
}

static options options_of(const method *m, const char *layers, unsigned inputs)
{
    options o;
    options_defaults(&o);
    o.method = m->name;
    o.layers = layers;
    if (m->source == SEES_MESH) o.mesh = "scene.obj";
    if (inputs & ENV) o.env = "sky.exr";
    return o;
}

static bool planned(const options *o, unsigned inputs, plan *p, error *e)
{
    log_t log;
    resolution r = resolution_of(inputs);
    *e = (error){0};
    log_init(&log, LOG_QUIET);
    bool ok = plan_make(o, &file, &r, p, &log, e);
    log_free(&log);
    return ok;
}

// What README's table of layers asks of method and input, with no option but these.
static bool can_be_made(layer_id l, const method *m, unsigned inputs)
{
    bool relit = inputs & ENV || !(inputs & BEAUTY);
    bool albedo = inputs & ALBEDO;
    switch (l) {
    case LAYER_INDIRECT:
        return m->bounce && (albedo || !relit || m->source == SEES_MESH);
    case LAYER_COMPOSITE:
        return albedo || !relit;
    case LAYER_DIFFUSE:
        return albedo && relit;
    case LAYER_SPECULAR:
        return inputs & ROUGHNESS && inputs & ENV;
    case LAYER_BENT:
        return method_makes(m, MAKES_BENT);
    case LAYER_SH_0:
    case LAYER_SH_1:
    case LAYER_SH_2:
        return method_makes(m, MAKES_SH);
    case LAYER_SH_3: // --sh-bands 3
    case LAYER_ERROR:
        return false; // --error
    default:
        return true;
    }
}

static bool runs(const plan *p, const char *pass)
{
    for (int i = 0; i < p->step_count; i++)
        if (strcmp(p->steps[i].pass, pass) == 0) return p->steps[i].runs;
    fail_msg("the plan has no step '%s'", pass);
    return false;
}

// What is reported is what was decided, and every step says why.
static void steps_are_the_decisions(const plan *p)
{
    assert_string_equal(p->steps[0].pass, p->method->name);
    assert_int_equal(runs(p, "irradiance"), p->irradiance);
    assert_int_equal(runs(p, "blur"), p->blur);
    assert_int_equal(runs(p, "tone"), p->tone);
    assert_int_equal(runs(p, "bounce"), p->bounce);
    assert_int_equal(runs(p, "specular"), p->specular);
    assert_int_equal(runs(p, "depthmask"), p->depthmask);
    assert_int_equal(runs(p, "composite"), p->composite);
    assert_int_equal(runs(p, "environment"), p->light);
    for (int i = 0; i < p->step_count; i++) assert_true(p->steps[i].why && p->steps[i].why[0]);
}

static void every_layer_alone(void **state)
{
    (void)state;
    const method *m;
    int made = 0, refused = 0;
    for (m = method_next(NULL, SEES_ANY); m; m = method_next(m, SEES_ANY))
        for (unsigned inputs = 0; inputs < SETS; inputs++)
            for (int l = 0; l < LAYER_COUNT; l++) {
                plan p;
                error e;
                options o = options_of(m, layer_table[l]->name, inputs);
                bool ok = planned(&o, inputs, &p, &e), can = can_be_made((layer_id)l, m, inputs);
                if (ok != can)
                    fail_msg("%s by %s with inputs %x: %s", layer_table[l]->name, m->name, inputs, ok ? "made" : e.message);
                made += ok, refused += !ok;
                if (!ok) {
                    assert_int_equal(e.code, ERR_INPUT);
                    assert_non_null(strstr(e.message, layer_table[l]->name));
                    continue;
                }
                bool relit = inputs & ENV || !(inputs & BEAUTY), lit = l == LAYER_COMPOSITE || l == LAYER_DIFFUSE;
                assert_int_equal(p.layers, 1u << l);
                assert_int_equal(p.composite, lit);
                assert_int_equal(p.specular, inputs & ROUGHNESS && inputs & ENV && (l == LAYER_SPECULAR || lit));
                assert_int_equal(p.depthmask, l == LAYER_DEPTHMASK);
                assert_int_equal(p.want_bent, l == LAYER_BENT);
                assert_int_equal(p.want_visibility, l == LAYER_VISIBILITY);
                if (l == LAYER_INDIRECT) assert_true(p.bounce);
                if (!lit && l != LAYER_INDIRECT) assert_false(p.bounce);
                if (l == LAYER_RADIANCE || (lit && relit)) assert_true(p.want_radiance || p.irradiance);
                assert_false(p.want_radiance && p.irradiance);
                if (l == LAYER_OCCLUSION || l == LAYER_BENT || l == LAYER_DEPTHMASK)
                    assert_false(p.light || p.want_radiance || p.irradiance || p.bounce);
                steps_are_the_decisions(&p);
            }
    assert_true(made > 1000 && refused > 1000);
}

// Of the default layers those that cannot be made are left out.
static void default_layers_are_those_that_can_be_made(void **state)
{
    (void)state;
    const method *m;
    for (m = method_next(NULL, SEES_ANY); m; m = method_next(m, SEES_ANY))
        for (unsigned inputs = 0; inputs < SETS; inputs++) {
            plan p;
            error e;
            unsigned wanted = 0;
            options o = options_of(m, NULL, inputs);
            for (int l = LAYER_OCCLUSION; l <= LAYER_COMPOSITE; l++)
                if (can_be_made((layer_id)l, m, inputs)) wanted |= 1u << l;
            must(planned(&o, inputs, &p, &e), &e);
            if (p.layers != wanted) fail_msg("%s with inputs %x: layers %x instead of %x", m->name, inputs, p.layers, wanted);
            steps_are_the_decisions(&p);
        }
}

// A beauty that holds its indirect light gets no second bounce; one whose direct diffuse light stands alone does.
static void the_bounce_goes_into_a_beauty_once(void **state)
{
    (void)state;
    const struct {
        unsigned inputs;
        const char *bounce;
        bool added;
    } rows[] = {
        {ALBEDO | BEAUTY, NULL, false},
        {ALBEDO | BEAUTY, "arc", true},
        {ALBEDO | BEAUTY | DIRECT, NULL, true},
        {ALBEDO | BEAUTY | DIRECT | INDIRECT, NULL, false},
        {ALBEDO | BEAUTY | ENV, NULL, true},
        {BEAUTY, NULL, false},
        {ALBEDO, NULL, true},
        {ALBEDO, "none", false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        plan p;
        error e;
        options o = options_of(method_find("arc"), "composite", rows[i].inputs);
        o.bounce = rows[i].bounce;
        must(planned(&o, rows[i].inputs, &p, &e), &e);
        if (p.bounce_in_composite != rows[i].added) fail_msg("row %zu: the bounce is %sadded", i, rows[i].added ? "not " : "");
    }
}

static void what_cannot_be_together_is_refused(void **state)
{
    (void)state;
    plan p;
    error e;
    options o = options_of(method_find("arc"), "occlusion", 0);
    o.method = "none";
    assert_false(planned(&o, 0, &p, &e));
    assert_int_equal(e.code, ERR_USAGE);
    for (const method *m = method_next(NULL, SEES_ANY); m; m = method_next(m, SEES_ANY))
        assert_non_null(strstr(e.message, m->name));
    o = options_of(method_find("arc"), "occlusion", 0);
    o.bounce = "none such";
    assert_false(planned(&o, 0, &p, &e));
    assert_int_equal(e.code, ERR_USAGE);
    for (const bounce_kind *const *b = bounces; *b; b++)
        assert_int_equal(strstr(e.message, (*b)->name) != NULL, (*b)->source == SEES_PICTURE);
    for (const method *m = method_next(NULL, SEES_ANY); m; m = method_next(m, SEES_ANY)) { // --error
        o = options_of(m, "occlusion,error", 0);
        o.error = 0.02;
        assert_int_equal(planned(&o, 0, &p, &e), method_makes(m, MAKES_ERROR));
    }
    o = options_of(method_find("raytrace"), "occlusion", 0);
    o.mesh = NULL;
    assert_false(planned(&o, 0, &p, &e));
    assert_non_null(strstr(e.message, "--mesh"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_layer_alone),
        cmocka_unit_test(default_layers_are_those_that_can_be_made),
        cmocka_unit_test(the_bounce_goes_into_a_beauty_once),
        cmocka_unit_test(what_cannot_be_together_is_refused),
    };
    return cmocka_run_group_tests_name("plan", tests, NULL, NULL);
}
