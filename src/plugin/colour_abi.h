// The border between the program (C) and the module ssdo-colour.so (C++). Returns 1, or 0 with a sentence in `message`.
#ifndef SSDO_PLUGIN_COLOUR_ABI_H
#define SSDO_PLUGIN_COLOUR_ABI_H

#include <stddef.h>

typedef int (*colour_to_linear_fn)(const char *config, const char *from, float *rgb, size_t n, char *message,
                                   size_t message_size);

// display, view NULL: the config's default ones.
typedef int (*colour_to_display_fn)(const char *config, const char *display, const char *view, float *rgb, size_t n,
                                    char *message, size_t message_size);

// What a conversion computes, as a text that other values in its tables change: from colour space `from` to scene_linear or,
// where that is NULL, from scene_linear to the display.
typedef int (*colour_identity_fn)(const char *config, const char *from, const char *display, const char *view, char *identity,
                                  size_t identity_size, char *message, size_t message_size);

#endif
