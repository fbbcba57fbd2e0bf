// --explain=json: what a pipeline checks once for a show.
#include <string.h>

#include "gbuffer/conventions.h"
#include "gbuffer/radius.h"
#include "pipeline/explain.h"
#include "pipeline/json.h"

static json_object *hypotheses_of(const verdict *v)
{
    json_object *list = json_object_new_array();
    for (int i = 0; i < v->count; i++) {
        json_object *o = json_object_new_object();
        json_put_text(o, "reading", v->tried[i].name);
        json_put_number(o, "fit", v->tried[i].fit);
        json_put_number(o, "loss", v->tried[i].loss);
        json_object_array_add(list, o);
    }
    return list;
}

static void put_verdict(json_object *o, const verdict *v)
{
    json_put_text(o, "verdict", v->doubtful ? "doubtful" : v->used ? "taken" : "not used");
    json_put_text(o, "reading", v->reading[0] ? v->reading : NULL);
    json_put_text(o, "measure", v->measure);
    json_put_number(o, "fit", v->fit);
    json_put_number(o, "next_fit", v->next);
    json_put(o, "hypotheses", hypotheses_of(v));
}

static json_object *roles_of(const frame_result *r, bool built)
{
    const verdict *const verdicts[ROLE_COUNT] = {
        [ROLE_POSITION] = &r->gb.position_verdict, [ROLE_NORMAL] = &r->gb.normal_verdict, [ROLE_DEPTH] = &r->gb.depth_verdict};
    json_object *roles = json_object_new_object();
    for (int i = 0; i < ROLE_COUNT; i++) {
        char text[512];
        if (!r->resolution.components[i]) continue;
        json_object *o = json_object_new_object();
        resolve_describe(r->file, &r->resolution, (role)i, text, sizeof text);
        const char *colon = strstr(text, ": ");
        json_put_text(o, "channels", colon ? colon + 2 : text);
        if (built && verdicts[i]) put_verdict(o, verdicts[i]);
        json_put(roles, role_name((role)i), o);
    }
    return roles;
}

static json_object *view_of(const frame_result *r, bool built)
{
    const convention *row = convention_named(r->resolution.convention);
    json_object *o = json_object_new_object(), *evidence = json_object_new_array();
    json_put_text(o, "view", r->view);
    json_put_text(o, "convention", row->name);
    json_put(o, "confirmed", json_object_new_boolean(row->confirmed));
    json_put_text(o, "recognised_by", r->resolution.mark);
    json_put_text(o, "view_layer", r->resolution.view_layer);
    json_put(o, "roles", roles_of(r, built));
    for (int i = 0; i < r->gb.evidence_count; i++) json_object_array_add(evidence, json_object_new_string(r->gb.evidence[i]));
    json_put(o, "evidence", evidence);
    if (!built) return o;
    json_put(o, "width", json_object_new_int(r->gb.width));
    json_put(o, "height", json_object_new_int(r->gb.height));
    json_put(o, "surfaces", json_object_new_int64((int64_t)r->gb.valid));
    json_put_number(o, "automatic_radius", gbuffer_auto_radius(&r->gb));
    json_put_text(o, "world_directions",
                  r->gb.camera.has_world      ? "known"
                  : r->gb.camera.has_rotation ? "known by the normals"
                                              : "unknown");
    return o;
}

void explain_json(const frame_result *first, bool built, const log_t *log, const error *why, FILE *to)
{
    json_object *o = json_object_new_object(), *views = json_object_new_array(), *warnings = json_object_new_array();
    char text[1600];
    bool doubtful = false;
    json_put_text(o, "version", SSDO_VERSION);
    json_put_text(o, "input", first->file ? first->file->path : why->file);
    for (const frame_result *v = first; v && v->file && v->resolution.convention; v = v->next_view) {
        json_object_array_add(views, view_of(v, built));
        doubtful = doubtful || (built && gbuffer_doubt(&v->gb));
    }
    for (int i = 0; i < log->warning_count; i++) {
        json_object *w = json_object_new_object();
        json_put_text(w, "key", log->keys[i]);
        json_put_text(w, "text", log->warnings[i]);
        json_object_array_add(warnings, w);
    }
    if (!built) err_format(why, text, sizeof text);
    json_put_text(o, "verdict", !built ? "refused" : doubtful ? "doubtful" : "read");
    json_put_text(o, "error", built ? NULL : text);
    json_put(o, "views", views);
    json_put(o, "warnings", warnings);
    fprintf(
        to, "%s\n",
        json_object_to_json_string_ext(o, JSON_C_TO_STRING_PRETTY | JSON_C_TO_STRING_SPACED | JSON_C_TO_STRING_NOSLASHESCAPE));
    json_object_put(o);
}
