// The layers we write, by name; what each holds stands in README.md, The layers.
#ifndef SSDO_PIPELINE_LAYERS_H
#define SSDO_PIPELINE_LAYERS_H

#include <stdbool.h>

#include "base/error.h"

typedef enum layer_id {
    LAYER_OCCLUSION,
    LAYER_RADIANCE,
    LAYER_INDIRECT,
    LAYER_COMPOSITE,
    LAYER_VISIBILITY,
    LAYER_SPECULAR,
    LAYER_DIFFUSE,
    LAYER_DEPTHMASK,
    LAYER_BENT,
    LAYER_SH_0, // LAYER_SH_0 + k
    LAYER_SH_1,
    LAYER_SH_2,
    LAYER_SH_3,
    LAYER_ERROR,
    LAYER_COUNT
} layer_id;

enum { LAYER_CHANNELS = 7 }; // of a layer, at most

// What a sample can be. NaN and infinity none can.
typedef enum layer_range {
    RANGE_ANY,
    RANGE_LIGHT, // not negative
    RANGE_SHARE, // 0 to 1
} layer_range;

typedef struct layer_info {
    const char *name;
    const char *channels; // one letter each, "RGB"
    layer_range range;
    bool by_default;
} layer_info;

extern const layer_info layer_table[LAYER_COUNT];

// "occlusion,radiance" to a bit set (1 << layer). NULL gives the default four. ERR_USAGE names an unknown layer and those there
// are.
bool layers_parse(const char *list, unsigned *set, error *e);

#endif
