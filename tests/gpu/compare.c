// compare A.exr B.exr RMS: how far the layers of two files lie apart, over the channels that both have. Exits 1 when the root
// mean square of a layer is above RMS or a picture is not of the same size.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/half.h"
#include "exr/file.h"

typedef struct layer {
    char name[64];
    double squares, largest, count;
} layer;

enum { MOST_LAYERS = 32 };

static double value_at(const exrio_channel *c, size_t i)
{
    if (c->type == SAMPLE_HALF) return (double)half_to_float(((const uint16_t *)c->data)[i]);
    return c->type == SAMPLE_FLOAT ? (double)((const float *)c->data)[i] : (double)((const uint32_t *)c->data)[i];
}

static exrio_part *load(const char *path, exrio_file **f)
{
    error e = {0};
    if (exrio_file_open(path, f, &e)) {
        exrio_part *p = &(*f)->parts[0];
        for (int i = 0; i < p->channel_count; i++) p->channels[i].wanted = true;
        if (exrio_file_load(*f, 2, &e)) return p;
    }
    fprintf(stderr, "compare: %s: %s\n", path, e.message);
    exit(2);
}

static layer *layer_of(layer *layers, int *count, const char *channel)
{
    const char *dot = strrchr(channel, '.');
    char name[sizeof layers->name];
    snprintf(name, sizeof name, "%.*s", dot ? (int)(dot - channel) : 1, channel);
    for (int i = 0; i < *count; i++)
        if (strcmp(layers[i].name, name) == 0) return &layers[i];
    if (*count == MOST_LAYERS) exit(2);
    layer *l = &layers[(*count)++];
    *l = (layer){.count = 0.0};
    memcpy(l->name, name, sizeof name);
    return l;
}

static void add(layer *l, const exrio_channel *a, const exrio_channel *b, size_t pixels)
{
    for (size_t i = 0; i < pixels; i++) {
        double d = fabs(value_at(a, i) - value_at(b, i));
        l->squares += d * d;
        l->largest = fmax(l->largest, d);
    }
    l->count += (double)pixels;
}

int main(int argc, char **argv)
{
    exrio_file *files[2];
    layer layers[MOST_LAYERS];
    int count = 0, bad = 0;
    if (argc != 4) return 2;
    const exrio_part *a = load(argv[1], &files[0]), *b = load(argv[2], &files[1]);
    if (!box2_equal(a->data_window, b->data_window)) {
        puts("the pictures differ in size");
        return 1;
    }
    size_t pixels = (size_t)box2_width(a->data_window) * (size_t)box2_height(a->data_window);
    for (int i = 0; i < a->channel_count; i++)
        for (int k = 0; k < b->channel_count; k++)
            if (strcmp(a->channels[i].name, b->channels[k].name) == 0)
                add(layer_of(layers, &count, a->channels[i].name), &a->channels[i], &b->channels[k], pixels);
    for (int i = 0; i < count; i++) {
        const layer *l = &layers[i];
        double rms = sqrt(l->squares / l->count);
        bool over = !(rms <= atof(argv[3]));
        printf("%s rms %.6f max %.4f%s\n", l->name, rms, l->largest, over ? " TOO FAR" : "");
        bad += over;
    }
    exrio_file_close(files[0]);
    exrio_file_close(files[1]);
    return count == 0 || bad > 0;
}
