// SPDX-License-Identifier: CC0-1.0
// Filters a file by libssdo, says how open the picture is in the mean, and writes what ssdo-filter would write.
//
//     cc filter.c -o filter $(pkg-config --cflags --libs ssdo)
//     ./filter in.exr out.exr [name=value ...]
#include <ssdo.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void tell(void *user, ssdo_level level, const char *text)
{
    fprintf(stderr, "%s: %s%s\n", (const char *)user, level == SSDO_WARNING ? "warning: " : "", text);
}

// The mean of a layer's first channel.
static double mean(const ssdo_frame *frame, const char *name)
{
    ssdo_layer layer = {.size = sizeof layer};
    int index = ssdo_find_layer(frame, name, NULL);
    if (ssdo_get_layer(frame, index, &layer) != SSDO_OK) return 0.0;
    size_t pixels = (size_t)layer.width * (size_t)layer.height, channels = strlen(layer.channels);
    double sum = 0.0;
    for (size_t i = 0; i < pixels; i++) sum += layer.pixels[i * channels];
    return sum / (double)pixels;
}

int main(int argc, char **argv)
{
    if (argc < 3) return fprintf(stderr, "usage: filter in.exr out.exr [name=value ...]\n"), 2;
    ssdo_setup setup = {.size = sizeof setup, .message = tell, .user = argv[0]};
    ssdo_context *context = ssdo_create(&setup);
    if (!context) return fprintf(stderr, "%s: no context\n", argv[0]), 6;
    ssdo_status status = SSDO_OK;
    for (int i = 3; i < argc && status == SSDO_OK; i++) {
        char *value = strchr(argv[i], '=');
        if (value) *value++ = '\0';
        status = ssdo_set(context, argv[i], value ? value : "1");
    }
    const char *files[] = {argv[1]};
    ssdo_input input = {.size = sizeof input, .files = files, .file_count = 1};
    ssdo_frame *frame = NULL;
    if (status == SSDO_OK) status = ssdo_filter(context, &input, &frame);
    if (status == SSDO_OK) {
        printf("occlusion %.4f in the mean\n", mean(frame, "occlusion"));
        status = ssdo_write(context, frame, argv[2]);
    }
    if (status != SSDO_OK) fprintf(stderr, "%s: %s\n", argv[0], ssdo_message(context));
    ssdo_free_frame(frame);
    ssdo_destroy(context);
    return (int)status;
}
