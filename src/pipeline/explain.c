#include "pipeline/explain.h"

#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/text.h"
#include "base/threads.h"
#include "cli/frames.h"
#include "gbuffer/conventions.h"
#include "gbuffer/radius.h"
#include "pipeline/batch.h"
#include "pipeline/filter.h"
#include "pipeline/inputs.h"
#include "pipeline/settings.h"
#include "plugin/colour.h"

static void heading(FILE *to, const char *text) { text_print(to, "\n%s\n", text); }

static void explain_renderer(const frame_result *r, FILE *to)
{
    const convention *row = convention_named(r->resolution.convention);
    text_print(to, "convention  %s%s, recognised by %s%s\n", row->name, row->confirmed ? "" : " (unverified)",
               r->resolution.mark ? "the header's " : "channel names", r->resolution.mark ? r->resolution.mark : "");
    if (!row->confirmed)
        text_print(to, "            unverified: written from documentation, no file of this renderer has confirmed it\n");
    if (r->resolution.view_layer[0]) text_print(to, "view layer  %s\n", r->resolution.view_layer);
    const exrio_part *part = &r->file->parts[r->resolution.main_part];
    text_print(to, "windows     data %d x %d at (%d, %d), display %d x %d\n", box2_width(part->data_window),
               box2_height(part->data_window), part->data_window.x0, part->data_window.y0, box2_width(part->display_window),
               box2_height(part->display_window));
}

static void explain_roles(const frame_result *r, FILE *to)
{
    heading(to, "channels");
    for (int i = 0; i < ROLE_COUNT; i++) {
        char line[512];
        resolve_describe(r->file, &r->resolution, (role)i, line, sizeof line);
        text_print(to, "  %s\n", line);
    }
    text_print(to, "  the albedo counts as %s (--albedo-kind)\n",
               r->resolution.albedo == ALBEDO_DIFFUSE ? "diffuse: free of metal" : "a base colour");
}

static void explain_evidence(const frame_result *r, FILE *to)
{
    heading(to, "evidence");
    for (int i = 0; i < r->gb.evidence_count; i++) text_print(to, "  %s\n", r->gb.evidence[i]);
    text_print(to, "  surfaces: %zu of %zu pixels\n", r->gb.valid, (size_t)r->gb.width * (size_t)r->gb.height);
    text_print(to, "  automatic radius: %g scene units\n", gbuffer_auto_radius(&r->gb));
    text_print(to, "  world directions: %s\n",
               r->gb.camera.has_world      ? "known"
               : r->gb.camera.has_rotation ? "known by the normals, the eye's place is not"
                                           : "unknown (--env needs --env-frame camera, --camera or --normal-space world)");
}

static void explain_colour(const options *o, const frame_result *r, FILE *to)
{
    double xy[8];
    heading(to, "colour");
    text_print(to, "  beauty and emission are taken as scene-linear; the albedo %s%s\n",
               o->albedo_colorspace ? "is converted from " : "too",
               o->albedo_colorspace ? o->albedo_colorspace : " (--albedo-colorspace names another space)");
    if (exrio_attr_chromaticities(r->file, r->resolution.main_part, xy))
        text_print(to, "  primaries by the header: red %.4g %.4g, green %.4g %.4g, blue %.4g %.4g, white %.4g %.4g\n", xy[0],
                   xy[1], xy[2], xy[3], xy[4], xy[5], xy[6], xy[7]);
    else
        text_print(to, "  the header does not say which primaries\n");
    const char *config = colour_config(o->ocio);
    text_print(to, "  OpenColorIO config: %s\n", config ? config : "none (--ocio, $OCIO)");
}

// Without the environment's pixels nobody knows whether it has suns.
static void explain_plan(const job *j, frame_result *r, FILE *to)
{
    heading(to, "what would run");
    r->set = settings_of(j, r, settings_shot(j, r));
    filter_list(r, false, &r->steps);
    for (int i = 0; i < r->steps.count; i++) {
        const plan_step *s = &r->steps.steps[i];
        bool open = strcmp(s->pass, "suns") == 0 && j->o->env && steps_split_suns(&r->plan);
        text_print(to, "  %-12s %s: %s\n", s->pass,
                   s->runs ? "yes"
                   : open  ? "?"
                           : "no",
                   open ? "if the environment has small bright sources" : s->why);
    }
    text_print(to, "  layers:");
    for (int l = 0; l < LAYER_COUNT; l++)
        if (r->plan.layers & 1u << l) text_print(to, " %s", layer_table[l]->name);
    text_print(to, "\n");
}

// The frame that is explained: of a sequence, the first.
static bool first_frame(const options *o, int *frame, error *e)
{
    frame_list frames = {0};
    *frame = 0;
    if (!inputs_are_framed(o)) return true;
    bool ok = o->frames ? frames_parse(o->frames, &frames, e) : pattern_scan(o->inputs[0], &frames, e);
    if (ok && frames.count == 0) ok = err_set(e, ERR_INPUT, o->inputs[0], NULL, "no file fits this pattern");
    if (ok) *frame = frames.frames[0];
    frames_free(&frames);
    return ok;
}

static bool explain_files(const options *o, const input_paths *in, FILE *to, error *e)
{
    options only_what_is_needed = *o;
    log_t log; // prints nothing: its warnings are part of the explanation
    frame_result r = {0};
    only_what_is_needed.keep_none = true;
    log_init(&log, LOG_QUIET);
    job j = {.o = &only_what_is_needed, .log = &log, .threads = o->threads > 0 ? o->threads : threads_default()};
    bool ok = frame_read_files(&j, in->list, in->count, &r, e);
    if (o->explain_json) {
        explain_json(&r, ok, &log, e, to);
        goto out;
    }
    for (int i = 0; i < in->count; i++) text_print(to, "%s\n", in->list[i]);
    for (frame_result *v = &r; v && v->file && v->resolution.convention; v = v->next_view) {
        if (v->view) text_print(to, "\nview %s\n", v->view);
        explain_renderer(v, to);
        explain_roles(v, to);
        if (!ok) continue;
        explain_evidence(v, to);
        explain_colour(o, v, to);
        explain_plan(&j, v, to);
    }
    if (log.warning_count) heading(to, "warnings");
    for (int i = 0; i < log.warning_count; i++) text_print(to, "  %s\n", log.warnings[i]);
out:
    frame_free(&r);
    log_free(&log);
    return ok;
}

bool explain_write(const options *o, FILE *to, error *e)
{
    int frame;
    input_paths *in = mem_zero(1, sizeof *in, e);
    bool ok = in && first_frame(o, &frame, e);
    if (ok && !inputs_of_frame(o, frame, in))
        ok = err_set(e, ERR_USAGE, o->inputs[0], NULL, "the path of frame %d is too long", frame);
    ok = ok && explain_files(o, in, to, e);
    free(in);
    return ok;
}
