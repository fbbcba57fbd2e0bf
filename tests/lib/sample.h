// The rendered samples and their path-traced truth (samples/scenes.json), and scoring against it (tests/README.md, reference B).
//
// Truth has noise. With two independent renders A and B, mean((x - A)(x - B)) is the squared error of x without that noise.
#ifndef SSDO_TESTS_SAMPLE_H
#define SSDO_TESTS_SAMPLE_H

#include "base/error.h"
#include "base/vec.h"

enum { SAMPLE_MAX = 16 };

typedef struct sample {
    char name[32], file[256], truth[256], env[256];
    double env_rotate, ao_distance, scene_size;
    bool orthographic, film_transparent;
    double focal, principal[2], pixels_per_unit, matrix_world[4][4]; // what Blender says of its camera
    int width, height;
    float *depth;                           // as stored
    float *ao[2], *direct[2], *indirect[2]; // renders A and B: 1, 3, 3 a pixel
    float *beauty, *alpha, *albedo;         // 3, 1, 3 a pixel
    float *normal;                          // 3 a pixel, as stored
    bool *scored; // pixels that one surface fills: Blender multiplies AO by coverage, so on edges it is not the truth
} sample;

// Reads DIR/scenes.json. Returns the number of scenes, 0 with the error filled if there are none.
int samples_list(const char *dir, sample *list, int max, error *e);
// Loads the pictures of one. Free with sample_free.
bool sample_load(sample *s, error *e);
void sample_free(sample *s);

// One layer of part 0 of a file as floats, interleaved: components `letters`. NULL with the error filled. The caller frees.
float *sample_read(const char *path, const char *layer, const char *letters, error *e);

// Pixels that count: a surface in the centre, and no background in the pixel.
static inline bool sample_is_surface(const sample *s, int i) { return s->scored[i]; }

typedef struct score {
    double rmse, bias, p99, mean; // of the surface pixels; p99 of |x - (A + B) / 2|; mean of the truth
    double constant_rmse;         // of the best constant picture
    double correlation, gain;     // gain: truth ~ gain * x by least squares
} score;

// Scores a layer of `channels` (1 or 3, interleaved) against renders a and b.
score sample_score(const sample *s, const float *x, const float *a, const float *b, int channels);

#endif
