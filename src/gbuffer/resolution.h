// Which channel is what: the roles, and what resolve.h found of them.
#ifndef SSDO_GBUFFER_RESOLUTION_H
#define SSDO_GBUFFER_RESOLUTION_H

#include "base/words.h"
#include "exr/file.h"

// What a channel (or a group of up to four) is used for.
typedef enum role {
    ROLE_POSITION,         // 3
    ROLE_NORMAL,           // 3
    ROLE_DEPTH,            // 1; 3 where it fills a picture's R G B, of which the first counts
    ROLE_ALBEDO,           // 3
    ROLE_BEAUTY,           // 3
    ROLE_ALPHA,            // 1
    ROLE_ROUGHNESS,        // 1
    ROLE_METALLIC,         // 1
    ROLE_EMISSION,         // 3
    ROLE_DIFFUSE_DIRECT,   // 3, light before albedo
    ROLE_DIFFUSE_INDIRECT, // 3, light before albedo
    ROLE_COUNT
} role;

const char *role_name(role r); // "position", ...

typedef struct channel_ref {
    int part, channel;
} channel_ref; // part -1: absent

typedef struct resolve_options {
    const char *names[ROLE_COUNT]; // --position, --normal, ...: layer or channel name; NULL = detect
    const char *view_layer;        // --view-layer, NULL = the only one
    const char *view;              // only channels of this stereo view, and of none; NULL = all
    depth_kind depth;
    albedo_kind albedo;
} resolve_options;

typedef struct resolution {
    channel_ref channels[ROLE_COUNT][4]; // components in order X Y Z / R G B
    int components[ROLE_COUNT];          // 0 = absent
    const char *convention;              // table row's name: "blender", "plain", ...
    const char *mark;                    // what in the header named it; NULL when the channel names did
    char view_layer[128];
    int main_part;           // the part that position/depth live in; its windows are the frame's
    depth_kind depth;        // DEPTH_AUTO until measured against P
    bool depth_told;         // by an option
    albedo_kind albedo;      // never AUTO after resolve
    bool up_is_z;            // the renderer's world up: default of --env-up
    double background_depth; // depths at or beyond this are background (besides inf, NaN, <= 0)
} resolution;

#endif
