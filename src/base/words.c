#include "base/words.h"

#include <stddef.h>

const option_word depth_kind_words[] = {
    {"planar", DEPTH_PLANAR},     {"radial", DEPTH_RADIAL},     {"inverse", DEPTH_INVERSE},
    {"linear", DEPTH_LINEAR},     {"inverted", DEPTH_INVERTED}, {"zbuffer", DEPTH_ZBUFFER},
    {"reversed", DEPTH_REVERSED}, {"ndc", DEPTH_NDC},           {NULL, 0},
};

const option_word albedo_kind_words[] = {{"base", ALBEDO_BASE}, {"diffuse", ALBEDO_DIFFUSE}, {NULL, 0}};

const option_word pass_space_words[] = {{"world", SPACE_WORLD}, {"camera", SPACE_CAMERA}, {NULL, 0}};

const option_word normal_encoding_words[] = {
    {"signed", NORMAL_SIGNED},
    {"unorm", NORMAL_UNORM},
    {"unorm-gamma", NORMAL_GAMMA},
    {"unorm-srgb", NORMAL_SRGB},
    {"unorm-degamma", NORMAL_DEGAMMA},
    {"unorm-desrgb", NORMAL_DESRGB},
    {NULL, 0},
};

const char *word_of(const option_word *words, double value)
{
    for (const option_word *w = words; w && w->text; w++)
        if (w->value == value) return w->text;
    return NULL;
}
