#include "light/alias_table.h"

#include <stdlib.h>

#include "base/mem.h"

static double luminance_at(const env_level *l, int x, int y)
{
    x = (x + l->width) % l->width;
    y = y < 0 ? 0 : y >= l->height ? l->height - 1 : y;
    const float *c = l->rgba + 4 * ((size_t)y * (size_t)l->width + (size_t)x);
    return luminance((double)c[0], (double)c[1], (double)c[2]);
}

// Mean over the texel of the bilinear interpolation between texel centres: without the neighbours' share, the dark texel beside
// a sun would be chosen rarely and found bright.
static double mean_of_lookup(const env_level *l, int x, int y)
{
    static const double tent[3] = {0.125, 0.75, 0.125};
    double sum = 0.0;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) sum += tent[j + 1] * tent[i + 1] * luminance_at(l, x + i, y + j);
    return sum;
}

// Texels below the mean are filled up by those above it, one donor each.
static void share_out(env_choice *table, double *weight, uint32_t *small, uint32_t *large, size_t n, double mean)
{
    size_t smalls = 0, larges = 0;
    for (size_t i = 0; i < n; i++) {
        weight[i] /= mean;
        if (weight[i] < 1.0)
            small[smalls++] = (uint32_t)i;
        else
            large[larges++] = (uint32_t)i;
    }
    while (smalls && larges) {
        uint32_t s = small[--smalls], l = large[larges - 1];
        table[s].keep = (float)weight[s];
        table[s].other = l;
        weight[l] -= 1.0 - weight[s];
        if (weight[l] < 1.0) small[smalls++] = large[--larges];
    }
    while (larges) table[large[--larges]].keep = 1.0f;
    while (smalls) table[small[--smalls]].keep = 1.0f; // rounding
}

bool env_alias_table_make(const environment *env, env_alias_table *out, error *e)
{
    int k = 0;
    while (k + 1 < env->level_count && (int64_t)env->levels[k].width * env->levels[k].height > ENV_MAX_CHOICES) k++;
    const env_level *l = &env->levels[k];
    size_t n = (size_t)l->width * (size_t)l->height;
    bool ok = false;
    double *weight = mem_pixels(n, sizeof *weight, e), total = 0.0;
    uint32_t *small = mem_pixels(n, sizeof *small, e), *large = mem_pixels(n, sizeof *large, e);
    *out = (env_alias_table){l->width, l->height, mem_zero(n, sizeof *out->table, e)};
    if (!weight || !small || !large || !out->table) goto out;
    for (int pass = 0; pass < 2 && !(total > 0.0); pass++)
        for (size_t i = 0; i < n; i++) {
            int x = (int)(i % (size_t)l->width), y = (int)(i / (size_t)l->width);
            weight[i] = (pass ? 1.0 : mean_of_lookup(l, x, y)) * env_texel_solid_angle(l->width, l->height, y);
            total += weight[i];
        }
    for (size_t i = 0; i < n; i++) {
        int y = (int)(i / (size_t)l->width);
        out->table[i].density = (float)(weight[i] / total / env_texel_solid_angle(l->width, l->height, y));
        out->table[i].other = (uint32_t)i;
    }
    share_out(out->table, weight, small, large, n, total / (double)n);
    ok = true;
out:
    free(weight);
    free(small);
    free(large);
    if (!ok) env_alias_table_free(out);
    return ok;
}

void env_alias_table_free(env_alias_table *c)
{
    free(c->table);
    *c = (env_alias_table){0};
}
