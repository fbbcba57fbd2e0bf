#include "passes/images.h"

#include "gbuffer/gbuffer.h"

const image_row image_table[IMAGE_COUNT] = {
#define IMAGE(id, ...) [IMAGE_##id] = {__VA_ARGS__},
#define LAYER(id, ...) [IMAGE_##id] = {.image = IMAGE_##id, __VA_ARGS__},
#define PASS_LAYER(id, run, ...) [IMAGE_##id] = {.image = IMAGE_##id, .pass = run, __VA_ARGS__},
#include "passes/image_rows.h"
#undef IMAGE
#undef LAYER
#undef PASS_LAYER
};

const image_row *const layer_table[LAYER_COUNT] = {
#define IMAGE(id, ...)
#define LAYER(id, ...) [LAYER_##id] = &image_table[IMAGE_##id],
#define PASS_LAYER(id, run, ...) LAYER(id, )
#include "passes/image_rows.h"
#undef IMAGE
#undef LAYER
#undef PASS_LAYER
};
