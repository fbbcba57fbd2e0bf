// core_copy IN.exr OUT.exr: reads and writes a one-part scanline file with OpenEXRCore's own pipelines, one thread, the library's
// default zip level: what a plain use of the library costs. Prints the CPU milliseconds of reading and of writing.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <openexr.h>

#include "base/clock.h"

#define MUST(call)                                                                                                               \
    do {                                                                                                                         \
        if ((call) != EXR_ERR_SUCCESS) {                                                                                         \
            fprintf(stderr, "core_copy: %s failed\n", #call);                                                                    \
            exit(1);                                                                                                             \
        }                                                                                                                        \
    } while (0)

typedef struct plane {
    unsigned char *bytes;
    int each;
} plane;

static void place(exr_coding_channel_info_t *c, plane *p, int line, int width)
{
    c->user_pixel_stride = p->each;
    c->user_line_stride = p->each * width;
    c->user_bytes_per_element = (int16_t)p->each;
    c->user_data_type = c->data_type;
    c->decode_to_ptr = p->bytes + (size_t)line * (size_t)width * (size_t)p->each;
}

int main(int argc, char **argv)
{
    exr_context_t in, out;
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_attr_box2i_t window;
    const exr_attr_chlist_t *list;
    int32_t lines;
    int part;
    if (argc != 3) return 2;
    double begun = clock_cpu_ms();
    MUST(exr_start_read(&in, argv[1], &init));
    MUST(exr_get_data_window(in, 0, &window));
    MUST(exr_get_channels(in, 0, &list));
    MUST(exr_get_scanlines_per_chunk(in, 0, &lines));
    int width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
    plane *planes = calloc((size_t)list->num_channels, sizeof *planes);
    for (int c = 0; planes && c < list->num_channels; c++) {
        planes[c].each = list->entries[c].pixel_type == EXR_PIXEL_HALF ? 2 : 4;
        planes[c].bytes = malloc((size_t)width * (size_t)height * (size_t)planes[c].each);
    }
    for (int y = 0; y < height; y += lines) {
        exr_chunk_info_t info;
        exr_decode_pipeline_t p = EXR_DECODE_PIPELINE_INITIALIZER;
        MUST(exr_read_scanline_chunk_info(in, 0, window.min.y + y, &info));
        MUST(exr_decoding_initialize(in, 0, &info, &p));
        for (int c = 0; c < p.channel_count; c++) place(&p.channels[c], &planes[c], y, width);
        MUST(exr_decoding_choose_default_routines(in, 0, &p));
        MUST(exr_decoding_run(in, 0, &p));
        MUST(exr_decoding_destroy(in, &p));
    }
    double was_read = clock_cpu_ms();
    MUST(exr_start_write(&out, argv[2], EXR_WRITE_FILE_DIRECTLY, &init));
    MUST(exr_add_part(out, "copy", EXR_STORAGE_SCANLINE, &part));
    MUST(exr_copy_unset_attributes(out, 0, in, 0));
    MUST(exr_write_header(out));
    for (int y = 0; y < height; y += lines) {
        exr_chunk_info_t info;
        exr_encode_pipeline_t p = EXR_ENCODE_PIPELINE_INITIALIZER;
        MUST(exr_write_scanline_chunk_info(out, 0, window.min.y + y, &info));
        MUST(exr_encoding_initialize(out, 0, &info, &p));
        for (int c = 0; c < p.channel_count; c++) place(&p.channels[c], &planes[c], y, width);
        MUST(exr_encoding_choose_default_routines(out, 0, &p));
        MUST(exr_encoding_run(out, 0, &p));
        MUST(exr_encoding_destroy(out, &p));
    }
    exr_finish(&in);
    MUST(exr_finish(&out));
    printf("%.1f %.1f\n", was_read - begun, clock_cpu_ms() - was_read);
    return 0;
}
