// own_copy IN.exr OUT.exr: reads all channels of a one-part file and writes them as the tool does, two threads. Prints the CPU
// milliseconds of reading and of writing, beside core_copy's.
#include <stdio.h>
#include <stdlib.h>

#include "base/clock.h"
#include "base/mem.h"
#include "exr/write.h"

static bool copy(const char *from, const char *to, double ms[2], error *e)
{
    exrio_file *f = NULL;
    exrio_out_channel *channels = NULL;
    bool ok = false;
    double begun = clock_cpu_ms();
    if (!exrio_file_open(from, &f, e)) return false;
    exrio_part *p = &f->parts[0];
    for (int c = 0; c < p->channel_count; c++) p->channels[c].wanted = true;
    channels = mem_zero((size_t)p->channel_count, sizeof *channels, e);
    if (!channels || !exrio_file_load(f, 2, e)) goto out;
    ms[0] = clock_cpu_ms() - begun;
    for (int c = 0; c < p->channel_count; c++)
        channels[c] = (exrio_out_channel){p->channels[c].name, p->channels[c].type, p->channels[c].data};
    exrio_out_part part = {.data_window = p->data_window,
                           .display_window = p->display_window,
                           .pixel_aspect = p->pixel_aspect,
                           .compression = p->compression,
                           .channels = channels,
                           .channel_count = p->channel_count,
                           .attributes_from = f};
    begun = clock_cpu_ms();
    ok = exrio_write(to, &part, 1, 2, e);
    ms[1] = clock_cpu_ms() - begun;
out:
    free(channels);
    exrio_file_close(f);
    return ok;
}

int main(int argc, char **argv)
{
    error e = {0};
    double ms[2];
    char text[1600];
    if (argc != 3) return 2;
    if (copy(argv[1], argv[2], ms, &e)) {
        printf("%.1f %.1f\n", ms[0], ms[1]);
        return 0;
    }
    err_format(&e, text, sizeof text);
    fprintf(stderr, "own_copy: %s\n", text);
    return 1;
}
