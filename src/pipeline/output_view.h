// What a view of the output has of ours: channels and attributes.
#ifndef SSDO_PIPELINE_OUTPUT_VIEW_H
#define SSDO_PIPELINE_OUTPUT_VIEW_H

#include "exr/write.h"
#include "pipeline/output_names.h"
#include "pipeline/views.h"

enum { MAX_OURS = LAYER_COUNT * 4 + 5, MAX_ATTRS = 12 + VIEWS_MAX };

// Everything exrio_write borrows for one view.
typedef struct assembly {
    char names[MAX_OURS][NAME_SIZE];
    exrio_out_channel ours[MAX_OURS];
    int our_count;
    exrio_out_attr attrs[MAX_ATTRS];
    int attr_count;
    char *args; // owned
    char camera[512], environment[600];
    char part_name[64], camera_name[64];
} assembly;

// The layers, and the composite's alpha.
void view_add_layers(assembly *a, const job *j, const frame_result *r);
// The channels of the composite once more, as R, G, B and A.
void view_add_main(assembly *a, const naming *n);
// What was done, with what. Allocates a->args.
bool view_add_attributes(assembly *a, const job *j, const frame_result *r, error *e);
// One more; the caller sets its value.
exrio_out_attr *view_add_attribute(assembly *a, const char *name, exrio_attr_kind kind);

#endif
