#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "bench.h"
#include "passes/trace.h"

static const int budgets[] = {8, 16, 32, 64, 128, 256};
enum { BUDGETS = sizeof budgets / sizeof *budgets, CONVERGED = 1024 };

// Rows besides a method's own: the same shader under another setting, at every second budget and at the method's defaults; with
// `defaults` only there. `converged`: at 1024 samples as well. What is 0 in `set` is as the method has it.
typedef struct bench_variant {
    const char *method, *suffix;
    bool defaults, converged;
    bench_row set;
} bench_variant;

static const bench_variant variants[] = {
    {"ssdo", ", no thickness", .set = {.thickness = INFINITY}},
    {"arc", ", no planes", .converged = true, .set = {.no_planes = true}},
    {"arc", ", with bent", .defaults = true, .set = {.extra = 1u << LAYER_BENT}},
    {"arc", ", bounce vpl 64", .defaults = true, .set = {.bounce = "vpl", .lights = 64}},
    {"arc", ", bounce vpl 256", .defaults = true, .set = {.bounce = "vpl", .lights = 256}},
    {"arc", ", bounce vpl 1024", .defaults = true, .set = {.bounce = "vpl", .lights = 1024}},
    {"arc", ", middle third alone", .defaults = true, .set = {.middle = true}},
    {"arc", ", middle third, --proxies", .defaults = true, .set = {.middle = true, .proxies = true}},
    {"alchemy", ", --preset scene", .defaults = true, .set = {.radius = 0.05, .scale = 2.0, .contrast = 3.0}},
    {"alchemy", ", --preset closeup", .defaults = true, .set = {.radius = 0.08, .scale = 1.7, .contrast = 2.2}},
    {"alchemy", ", with depthmask", .defaults = true, .set = {.extra = 1u << LAYER_DEPTHMASK}},
    {"s3ho", ", --sh-bands 3", .defaults = true, .set = {.sh_bands = 3}},
    {"s3ho", ", --sh-sigma 0.3", .defaults = true, .set = {.sh_sigma = 0.3}},
    {"s3ho", ", --from-sh", .defaults = true, .set = {.relit = true}},
};

// Methods whose error with (nearly) endless samples are compared.
static bool is_slices(const method *m)
{
    return strcmp(m->name, "arc") == 0 || strcmp(m->name, "gtao") == 0 || strcmp(m->name, "bitmask") == 0;
}

static bench_row row_of(const method *m, const char *suffix, int samples, int blur)
{
    bench_row r = {
        .kind = ROW_METHOD, .m = m, .samples = samples, .blur = blur, .thickness = -1.0, .scale = 1.0, .contrast = 1.0};
    snprintf(r.name, sizeof r.name, "%s%s", m->name, suffix);
    return r;
}

static bench_row budget_row(const method *m, const bench_variant *v, int samples, int blur)
{
    bench_row r = v->set, plain = row_of(m, v->suffix, samples, blur);
    r.kind = plain.kind, r.m = m, r.samples = samples, r.blur = blur;
    memcpy(r.name, plain.name, sizeof r.name);
    if (r.thickness == 0.0) r.thickness = plain.thickness;
    if (r.scale == 0.0) r.scale = plain.scale;
    if (r.contrast == 0.0) r.contrast = plain.contrast;
    r.standard = blur > 0;
    return r;
}

static int variant_rows(const method *m, const bench_variant *v, bench_row *rows)
{
    int n = 0;
    for (int i = 1; !v->defaults && i < BUDGETS; i += 2) rows[n++] = budget_row(m, v, budgets[i], 0);
    if (v->converged) rows[n++] = budget_row(m, v, CONVERGED, 0);
    rows[n++] = budget_row(m, v, m->samples, m->blur);
    return n;
}

static int oracles(bench_row *rows)
{
    static const struct {
        row_kind kind;
        const char *name;
    } list[] = {{ROW_OPEN, "constant 1"},
                {ROW_CONSTANT, "best constant (oracle)"},
                {ROW_IRRADIANCE, "irradiance(n)"},
                {ROW_TRUE_AO, "irradiance(n) x true AO (oracle)"}};
    int n = 0;
    for (; n < 4; n++) {
        rows[n] = (bench_row){.kind = list[n].kind, .standard = true};
        snprintf(rows[n].name, sizeof rows[n].name, "%s", list[n].name);
    }
    return n;
}

static int method_rows(const method *m, bench_row *rows)
{
    int n = 0;
    for (int i = 0; i < BUDGETS; i++) rows[n++] = row_of(m, "", budgets[i], 0);
    if (is_slices(m)) rows[n++] = row_of(m, "", CONVERGED, 0);
    rows[n++] = row_of(m, "", m->samples, m->blur);
    rows[n - 1].standard = true;
    rows[n++] = row_of(m, "", 4 * m->samples, m->blur);                // --quality high
    rows[n] = row_of(m, ", half resolution", m->samples / 4, m->blur); // --quality draft
    rows[n++].half = true;
    rows[n] = row_of(m, ", half resolution", m->samples, m->blur);
    rows[n].half = rows[n].standard = true;
    n++;
    for (size_t v = 0; v < sizeof variants / sizeof *variants; v++)
        if (strcmp(variants[v].method, m->name) == 0) n += variant_rows(m, &variants[v], rows + n);
    return n;
}

// The reference, which costs what it costs: timed once.
static int raytrace_rows(bench_row *rows)
{
    static const struct {
        const char *suffix;
        int samples, trace;
    } list[] = {{"", 16, TRACE_EMBREE}, {"", 64, TRACE_EMBREE}, {", --trace gpu", 8, TRACE_GPU}};
    int n = 0;
    for (; n < 3; n++) {
        rows[n] = row_of(method_find("raytrace"), list[n].suffix, list[n].samples, 0);
        rows[n].trace = list[n].trace;
        rows[n].once = rows[n].standard = true;
    }
    return n;
}

int bench_rows(bench_row *rows, int max, double scale, double contrast)
{
    enum { MOST = 40 }; // of one method
    int n = oracles(rows);
    for (const method *m = method_next(NULL, SEES_PICTURE); m && n + 2 * MOST < max; m = method_next(m, SEES_PICTURE)) {
        n += method_rows(m, rows + n);
        if (strcmp(m->name, "alchemy") != 0) continue;
        for (int i = 0; i < BUDGETS - 1; i++) {
            bench_row r = row_of(m, ", best scale and contrast", budgets[i], m->blur);
            r.scale = scale, r.contrast = contrast;
            r.standard = r.samples == m->samples;
            rows[n++] = r;
        }
    }
    return n + raytrace_rows(rows + n);
}

// ---- Alchemy's best look

typedef struct look_sums {
    float *s, *a, *b; // obscurance and both truths at the pixels that count
    size_t count;
} look_sums;

// Every ninth surface pixel: the choice of two numbers does not need all.
static bool collect(rig *r, const bench_scene *b, look_sums *out, error *e)
{
    const double quarter = 0.25; // 1 - S / 4 stays clear of the layer's bounds
    bench_row row = row_of(method_find("alchemy"), "", method_find("alchemy")->samples, method_find("alchemy")->blur);
    row.scale = quarter;
    frame_result f;
    size_t n = (size_t)b->gb.width * (size_t)b->gb.height, seen = 0;
    if (!bench_run(r, b, &row, 1 << LAYER_OCCLUSION, &f, NULL, NULL, e)) return false;
    out->s = mem_pixels(n, sizeof(float), e), out->a = mem_pixels(n, sizeof(float), e), out->b = mem_pixels(n, sizeof(float), e);
    for (size_t i = 0; out->s && out->a && out->b && i < n; i++) {
        if (!sample_is_surface(&b->s, (int)i) || seen++ % 9) continue;
        out->s[out->count] = (1.0f - f.layers[LAYER_OCCLUSION][i]) / (float)quarter;
        out->a[out->count] = b->s.ao[0][i];
        out->b[out->count++] = b->s.ao[1][i];
    }
    rig_free_result(&f);
    return out->s && out->a && out->b;
}

static double error_of(const look_sums *l, double scale, double contrast)
{
    double sum = 0.0;
    for (size_t i = 0; i < l->count; i++) {
        double x = pow(fmax(0.0, 1.0 - scale * (double)l->s[i]), contrast);
        sum += (x - (double)l->a[i]) * (x - (double)l->b[i]);
    }
    return l->count ? sum / (double)l->count : 0.0;
}

bool bench_fit_alchemy(rig *r, const bench_scene *scenes, int count, double *scale, double *contrast, error *e)
{
    look_sums l[BENCH_SCENES] = {0};
    double best = INFINITY;
    bool ok = method_find("alchemy") != NULL;
    for (int i = 0; ok && i < count; i++) ok = collect(r, &scenes[i], &l[i], e);
    for (int a = 2; ok && a <= 30; a++)
        for (int c = 2; c <= 32; c++) {
            double sum = 0.0;
            for (int i = 0; i < count; i++) sum += error_of(&l[i], 0.1 * a, 0.25 * c);
            if (sum < best) best = sum, *scale = 0.1 * a, *contrast = 0.25 * c;
        }
    for (int i = 0; i < count; i++) free(l[i].s), free(l[i].a), free(l[i].b);
    return ok;
}
