#include "pipeline/output_view.h"

#include <stdio.h>
#include <string.h>

void view_add_main(assembly *a, const naming *n)
{
    char name[NAME_SIZE];
    for (const char *c = "RGBA"; *c; c++) {
        layer_channel(n, "composite", *c, name);
        for (int i = 0, count = a->our_count; i < count; i++) {
            if (strcmp(a->names[i], name) != 0) continue;
            view_name(n->file, n->view, (const char[]){*c, 0}, a->names[a->our_count], NAME_SIZE);
            a->ours[a->our_count] = (exrio_out_channel){a->names[a->our_count], a->ours[i].type, a->ours[i].data};
            a->our_count++;
        }
    }
}

void view_add_layers(assembly *a, const job *j, const frame_result *r)
{
    const naming n = naming_of(j, r);
    for (int l = 0; l < LAYER_COUNT; l++)
        for (int k = 0; r->samples[l][0] && layer_table[l]->channels[k]; k++) {
            layer_channel(&n, layer_table[l]->name, layer_table[l]->channels[k], a->names[a->our_count]);
            a->ours[a->our_count] = (exrio_out_channel){a->names[a->our_count], r->types[l], r->samples[l][k]};
            a->our_count++;
        }
    if (!r->samples[LAYER_COMPOSITE][0] || !r->resolution.components[ROLE_ALPHA]) return;
    // The composite's alpha is the input's own, bits and type.
    channel_ref ref = r->resolution.channels[ROLE_ALPHA][0];
    const exrio_channel *alpha = &r->file->parts[ref.part].channels[ref.channel];
    layer_channel(&n, "composite", 'A', a->names[a->our_count]);
    a->ours[a->our_count] = (exrio_out_channel){a->names[a->our_count], alpha->type, alpha->data};
    a->our_count++;
}

exrio_out_attr *view_add_attribute(assembly *a, const char *name, exrio_attr_kind kind)
{
    exrio_out_attr *attr = &a->attrs[a->attr_count++];
    *attr = (exrio_out_attr){.name = name, .kind = kind};
    return attr;
}

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

bool view_add_attributes(assembly *a, const job *j, const frame_result *r, error *e)
{
    static const char *sources[] = {"option", "fit", "header", "plane"};
    const camera *c = &r->gb.camera;
    view_add_attribute(a, "ssdo/version", EXRIO_OUT_STRING)->string = SSDO_VERSION;
    a->args = options_record(j->o, e);
    if (!a->args) return false;
    view_add_attribute(a, "ssdo/args", EXRIO_OUT_STRING)->string = a->args;
    snprintf(a->camera, sizeof a->camera, "%s focal %.9g %.9g centre %.9g %.9g source %s",
             c->kind == CAMERA_ORTHOGRAPHIC ? "orthographic" : "perspective", c->fx, c->fy, c->cx, c->cy, sources[c->source]);
    view_add_attribute(a, "ssdo/camera", EXRIO_OUT_STRING)->string = a->camera;
    view_add_attribute(a, "ssdo/radius", EXRIO_OUT_FLOAT)->number = r->set.radius;
    view_add_attribute(a, "ssdo/device", EXRIO_OUT_STRING)->string = j->g.device;
    view_add_attribute(a, "ssdo/method", EXRIO_OUT_STRING)->string = r->plan.method->name;
    snprintf(a->environment, sizeof a->environment, "%s", j->o->env ? base_name(j->o->env) : "white, radiance 1");
    if (r->plan.light) view_add_attribute(a, "ssdo/environment", EXRIO_OUT_STRING)->string = a->environment;
    // A part of our own copies nothing else from the input's.
    if (view_in_names(r->file, r->view)) {
        exrio_out_attr *views = view_add_attribute(a, "multiView", EXRIO_OUT_STRINGS);
        views->string_count = exrio_attr_strings(r->file, r->resolution.main_part, "multiView", views->strings, EXRIO_VIEWS);
    }
    exrio_out_attr primaries = {.name = "chromaticities", .kind = EXRIO_OUT_CHROMATICITIES};
    if (exrio_attr_chromaticities(r->file, r->resolution.main_part, primaries.xy)) a->attrs[a->attr_count++] = primaries;
    view_add_attribute(a, "ssdo/premult", EXRIO_OUT_STRING)->string =
        "composite: premultiplied; occlusion, visibility: ratios; radiance, indirect: per unit coverage";
    return true;
}
