// The border between the program (C) and the module ssdo-images.so (C++): what images_shim.cpp exports and images.c looks up.
//
// Each returns 1, or 0 with a sentence in `message`. Memory that crosses is malloc'ed by the module and freed by the program.
#ifndef SSDO_PLUGIN_IMAGES_ABI_H
#define SSDO_PLUGIN_IMAGES_ABI_H

#include <stddef.h>
#include <stdint.h>

// Takes rows of an image, top first: `channels` floats a pixel, `rows` rows from `y` on; before the first ones once with no rows,
// so that size and channels are known. Returns 0 to stop.
typedef int (*images_take_fn)(void *context, int width, int height, int channels, int y, int rows, const float *pixels);
typedef int (*images_read_rows_fn)(const char *path, int part, images_take_fn take, void *context, char *message,
                                   size_t message_size);
// A PNG file in *bytes. label: a text that it carries as `key`.
typedef int (*images_encode_png_fn)(int width, int height, const uint8_t *rgb, const char *key, const char *label, void **bytes,
                                    size_t *size, char *message, size_t message_size);

#endif
