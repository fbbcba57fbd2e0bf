// The border between the program (C) and the module ssdo-colour.so (C++). Returns 1, or 0 with a sentence in `message`.
#ifndef SSDO_PLUGIN_COLOUR_ABI_H
#define SSDO_PLUGIN_COLOUR_ABI_H

#include <stddef.h>

typedef int (*colour_to_linear_fn)(const char *config, const char *from, float *rgb, size_t n, char *message,
                                   size_t message_size);

// display, view NULL: the config's default ones.
typedef int (*colour_to_display_fn)(const char *config, const char *display, const char *view, float *rgb, size_t n,
                                    char *message, size_t message_size);

#endif
