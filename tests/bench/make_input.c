// make_input WIDTH HEIGHT FILE.exr [clean]: a G-buffer of any size for `make bench-frame`: the test still life, 13 channels as
// renderers write them (half R G B, albedo, N; float P, Z), ZIP. Albedo and beauty hold noise, which costs a copy most of its
// time, or with `clean` none: flat albedo, and a beauty shaded by one light.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <openexr.h>

#include "base/half.h"
#include "exr/write.h"
#include "scene_picture.h"

enum { CHANNELS = 13 };

static float hash(unsigned v)
{
    v = (v ^ 61u) ^ (v >> 16);
    v *= 9u;
    v ^= v >> 4;
    v *= 0x27d4eb2du;
    v ^= v >> 15;
    return (float)(v >> 8) / 16777216.0f;
}

// Components k of n, as halves, each times 1 +- noise.
static void half_plane(const float *from, int k, size_t n, float noise, unsigned seed, uint16_t *to)
{
    for (size_t i = 0; i < n; i++)
        to[i] = float_to_half(from[3 * i + (size_t)k] * (1.0f + noise * (hash((unsigned)i * 3u + (unsigned)k + seed) - 0.5f)));
}

static void float_plane(const float *from, int k, size_t n, float *to)
{
    for (size_t i = 0; i < n; i++) to[i] = from[3 * i + (size_t)k];
}

// Of a far light above the camera.
static void shade_plane(const picture *p, int k, size_t n, uint16_t *to)
{
    for (size_t i = 0; i < n; i++) {
        float cosine = 0.6f * p->normal[3 * i + 1] + 0.8f * p->normal[3 * i + 2];
        to[i] = float_to_half(p->albedo[3 * i + (size_t)k] * (0.2f + 0.8f * (cosine > 0.0f ? cosine : 0.0f)));
    }
}

int main(int argc, char **argv)
{
    static const char *names[CHANNELS] = {"R",   "G",   "B",   "albedo.R", "albedo.G", "albedo.B", "N.X",
                                          "N.Y", "N.Z", "P.X", "P.Y",      "P.Z",      "Z"};
    bool clean = argc == 5 && strcmp(argv[4], "clean") == 0;
    if (argc != 4 && !clean) return 2;
    scene s = {0};
    picture p;
    error e = {0};
    scene_clutter(&s);
    view v = view_perspective(atoi(argv[1]), atoi(argv[2]), 50.0, 1.0);
    view_scene(&v, &s);
    if (!scene_picture(&s, &v, &p, &e)) return 1;
    size_t n = (size_t)p.width * (size_t)p.height;
    exrio_out_channel channels[CHANNELS];
    void *planes[CHANNELS];
    for (int c = 0; c < CHANNELS; c++) {
        bool half = c < 9;
        void *data = malloc(n * (half ? 2 : 4));
        if (!data) return 1;
        if (c < 3 && clean)
            shade_plane(&p, c, n, data);
        else if (c < 3)
            half_plane(p.albedo, c, n, 0.3f, 77u, data);
        else if (half)
            half_plane(c < 6 ? p.albedo : p.normal, c % 3, n, c < 6 && !clean ? 0.05f : 0.0f, 5u, data);
        else if (c < 12)
            float_plane(p.position, c - 9, n, data);
        else
            memcpy(data, p.depth, n * 4);
        planes[c] = data;
        channels[c] = (exrio_out_channel){names[c], half ? SAMPLE_HALF : SAMPLE_FLOAT, data};
    }
    exrio_out_part part = {.data_window = v.data_window,
                           .display_window = v.display_window,
                           .pixel_aspect = 1.0f,
                           .compression = EXR_COMPRESSION_ZIP,
                           .channels = channels,
                           .channel_count = CHANNELS};
    char text[1024];
    bool ok = exrio_write(argv[3], &part, 1, 2, &e);
    err_format(&e, text, sizeof text);
    for (int c = 0; c < CHANNELS; c++) free(planes[c]);
    picture_free(&p);
    if (!ok) fprintf(stderr, "make_input: %s\n", text);
    return ok ? 0 : 1;
}
