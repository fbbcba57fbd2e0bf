#include "tile_errors.h"

#include <math.h>
#include <stdlib.h>

#include "base/mem.h"

float *tile_limit(rig *r, const gbuffer *gb, const method *m, pass_settings set, int samples, int runs, error *e)
{
    size_t n = (size_t)gb->width * (size_t)gb->height;
    float *mean = mem_zero(n, sizeof *mean, e);
    set.target_error = 0.0, set.blur = 0, set.samples = samples;
    for (int run = 0; mean && run < runs; run++) {
        frame_result f;
        set.seed = 1000 + run;
        if (!rig_run(r, gb, m, &set, 1u << LAYER_OCCLUSION, &f, e)) {
            free(mean);
            return NULL;
        }
        for (size_t i = 0; i < n; i++) mean[i] += f.layers[LAYER_OCCLUSION][i] / (float)runs;
        rig_free_result(&f);
    }
    return mean;
}

typedef struct sums {
    double truth, estimate, count;
} sums;

static sums add_tile(const gbuffer *gb, const float *occlusion, const float *limit, const float *estimate, int x0, int y0)
{
    sums s = {0};
    for (int y = y0; y < y0 + GPU_TILE && y < gb->height; y++)
        for (int x = x0; x < x0 + GPU_TILE && x < gb->width; x++) {
            size_t i = (size_t)y * (size_t)gb->width + (size_t)x;
            if (gb->depth[i] == 0.0f) continue;
            s.truth += pow((double)occlusion[i] - (double)limit[i], 2.0);
            if (estimate) s.estimate += pow((double)estimate[i], 2.0);
            s.count += 1.0;
        }
    return s;
}

tile_errors tile_errors_of(const gbuffer *gb, const float *occlusion, const float *limit, const float *estimate, double wanted)
{
    const double least = 5e-4;
    tile_errors t = {0};
    sums all = {0};
    for (int y = 0; y < gb->height; y += GPU_TILE)
        for (int x = 0; x < gb->width; x += GPU_TILE) {
            sums s = add_tile(gb, occlusion, limit, estimate, x, y);
            if (s.count == 0.0) continue;
            double truth = sqrt(s.truth / s.count), ratio = fmax(truth, least) / fmax(sqrt(s.estimate / s.count), least);
            t.tiles++;
            t.largest = fmax(t.largest, truth);
            t.below += truth < wanted;
            t.within_2 += ratio >= 0.5 && ratio <= 2.0;
            t.over_2 += ratio > 2.0;
            all.truth += s.truth, all.estimate += s.estimate, all.count += s.count;
        }
    t.rms = all.count > 0.0 ? sqrt(all.truth / all.count) : 0.0;
    t.estimated = all.count > 0.0 ? sqrt(all.estimate / all.count) : 0.0;
    return t;
}
