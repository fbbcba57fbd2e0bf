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
#include "pipeline/steps.h"

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

static pass_settings settings_for(const plan *p, const options *o)
{
    return (pass_settings){.radius = 1.0,
                           .samples = p->method->samples,
                           .target_error = o->error,
                           .blur = o->blur < 0 ? p->method->blur : o->blur,
                           .sh_bands = o->sh_bands,
                           .size = o->resolution > RESOLUTION_FULL ? (estimate_size)o->resolution : SIZE_FULL,
                           .relight = p->relight};
}

// What the G-buffer brings: what the plan needs of what the file has.
static image_set given_by(const plan *p)
{
    static const struct {
        unsigned need;
        image_id image;
    } table[] = {{NEED_ALBEDO, IMAGE_ALBEDO},     {NEED_BEAUTY, IMAGE_BEAUTY},     {NEED_BACKGROUND, IMAGE_BEAUTY},
                 {NEED_MATERIAL, IMAGE_MATERIAL}, {NEED_EMISSION, IMAGE_EMISSION}, {NEED_DIFFUSE_LIGHT, IMAGE_DIFFUSE_DIRECT},
                 {NEED_COVERAGE, IMAGE_COVERAGE}};
    image_set given = IMAGE_BIT(IMAGE_DEPTH) | IMAGE_BIT(IMAGE_NORMAL);
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        if (p->need & table[i].need) given |= IMAGE_BIT(table[i].image);
    return given;
}

static const plan_step *step_named(const step_list *l, const char *pass)
{
    for (int i = 0; i < l->count; i++)
        if (strcmp(l->steps[i].pass, pass) == 0) return &l->steps[i];
    fail_msg("no step '%s'", pass);
    return NULL;
}

// Every picture that a step reads is there before it, at its size, and what is asked for is there in the end.
static void pictures_flow(const plan *p, const step_list *l, const pass_settings *set, image_set given)
{
    image_set whole = given, small = steps_use_small(p, set) ? steps_given_small(p, set, given) : 0;
    bool ended = false;
    for (int i = 0; i < l->count; i++) {
        const plan_step *s = &l->steps[i];
        assert_true(s->why && s->why[0]);
        if (!s->runs) ended = true;
        if (!s->runs) continue;
        assert_false(ended); // first what runs, then what does not
        image_set *from = s->size == STEP_SMALL || s->size == STEP_UP ? &small : &whole;
        image_set *to = s->size == STEP_WHOLE || s->size == STEP_UP ? &whole : &small;
        if (s->reads & ~*from)
            fail_msg("%s by %s reads %llx, and there is %llx", s->pass, p->method->name, (unsigned long long)s->reads,
                     (unsigned long long)*from);
        bool moves = s->size == STEP_UP || s->size == STEP_DOWN;
        if (moves) assert_int_equal(s->reads, s->writes);
        assert_true(s->writes && (moves || s->run));
        *to |= s->writes;
    }
    for (int i = 0; i < LAYER_COUNT; i++) {
        const image_row *row = layer_table[i];
        bool made = whole & IMAGE_BIT(row->image) || (row->otherwise && whole & IMAGE_BIT(row->otherwise));
        if (p->layers & 1u << i && !made) fail_msg("nothing makes %s by %s", row->name, p->method->name);
    }
}

// The plan's decisions are the steps' too, whatever else the frame has.
static void steps_follow(const plan *p, const options *o)
{
    for (int size = SIZE_FULL; size <= SIZE_HALF; size++)
        for (int more = 0; more < 8; more++) {
            pass_settings set = settings_for(p, o);
            step_list l;
            bool proxies = more & 1, lone = more & 4, mixed = more & 2, suns = more & 2 && steps_split_suns(p);
            set.size = o->error <= 0.0 && !p->from_sh ? (estimate_size)size : SIZE_FULL;
            if (more & 4) set.samples *= 16;
            image_set given = given_by(p);
            const step_facts facts = {p, &set, given, proxies, suns, mixed, lone};
            steps_make(&facts, &l);
            pictures_flow(p, &l, &set, given);
            assert_true(step_named(&l, p->method->name)->runs);
            assert_int_equal(step_named(&l, "irradiance")->runs, p->irradiance);
            assert_int_equal(step_named(&l, "tone")->runs, p->tone);
            assert_int_equal(step_named(&l, "mix")->runs, mixed);
            assert_int_equal(step_named(&l, "bounce")->runs, p->bounce && !steps_bounce_within(&facts));
            assert_int_equal(step_named(&l, "specular")->runs, p->specular);
            assert_int_equal(step_named(&l, "depthmask")->runs, p->depthmask);
            assert_int_equal(step_named(&l, "composite")->runs, p->composite);
            assert_int_equal(step_named(&l, "edges")->runs, true);
            bool light = set.size == SIZE_LIGHT && p->method->run_light && (p->want_radiance || p->want_visibility || p->bounce);
            assert_int_equal(step_named(&l, p->method->name)->size, set.size == SIZE_HALF ? STEP_SMALL : STEP_WHOLE);
            assert_int_equal(step_named(&l, "light")->runs, light && (p->want_radiance || p->want_visibility));
            assert_int_equal(step_named(&l, "refine")->runs, light && lone);
            assert_int_equal(step_named(&l, "upsample")->runs, set.size == SIZE_HALF || light);
            assert_int_equal(step_named(&l, "proxies")->runs, proxies);
            assert_int_equal(step_named(&l, "suns")->runs, suns);
        }
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
                steps_follow(&p, &o);
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
            steps_follow(&p, &o);
        }
}

// Any set of the layers that can be made, with every bounce, half resolution or an error that is asked for, spheres and suns.
static void every_set_of_layers_flows(void **state)
{
    (void)state;
    static const char *const estimators[] = {NULL, "arc", "ssdo", "vpl", "none"};
    const method *m;
    int lists = 0;
    for (m = method_next(NULL, SEES_ANY); m; m = method_next(m, SEES_ANY))
        for (unsigned inputs = 0; inputs < SETS; inputs++)
            for (unsigned set = 1; set < 1u << LAYER_COUNT; set += 1 + 97u * (set > 64)) {
                char layers[256] = "";
                for (int l = 0; l < LAYER_COUNT; l++)
                    if (set >> l & 1u && can_be_made((layer_id)l, m, inputs))
                        snprintf(layers + strlen(layers), sizeof layers - strlen(layers), "%s%s", layers[0] ? "," : "",
                                 layer_table[l]->name);
                plan p;
                error e;
                options o = options_of(m, layers, inputs);
                o.bounce = estimators[lists % 5];
                o.error = lists % 6 == 0 && method_makes(m, MAKES_ERROR) ? 0.02 : 0.0;
                o.resolution = (estimate_resolution)(lists % 3);
                if (o.resolution > RESOLUTION_FULL) o.error = 0.0;
                if (!layers[0] || !planned(&o, inputs, &p, &e)) continue;
                pass_settings s = settings_for(&p, &o);
                step_list l;
                steps_make(&(step_facts){&p, &s, given_by(&p), lists % 7 == 0, lists % 4 == 0 && steps_split_suns(&p),
                                         lists % 3 == 0, lists % 5 == 0},
                           &l);
                pictures_flow(&p, &l, &s, given_by(&p));
                lists++;
            }
    assert_true(lists > 10000);
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
        cmocka_unit_test(every_set_of_layers_flows),
        cmocka_unit_test(the_bounce_goes_into_a_beauty_once),
        cmocka_unit_test(what_cannot_be_together_is_refused),
    };
    return cmocka_run_group_tests_name("plan", tests, NULL, NULL);
}
