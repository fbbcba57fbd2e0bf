// Warnings about samples that could not be used, with the share of the pixels they touch.
#include "gbuffer/build.h"

// More than a thousandth is worth a word; less is a firefly.
static void warn_of(build *b, const char *key, size_t bad, size_t of, const char *what)
{
    if (bad > of / 1000) log_warn(b->log, key, "%.2g %% of %s", 100.0 * (double)bad / (double)of, what);
}

void defects_warn(build *b)
{
    size_t pixels = (size_t)b->g->width * (size_t)b->g->height;
    warn_of(b, "bad-positions", atomic_load(&b->defects.positions), pixels,
            "the pixels have a position that is NaN, infinite or far off its pixel; they count by their depth if that is "
            "known, else as empty (--position names another channel)");
    warn_of(b, "bad-normals", atomic_load(&b->defects.normals), pixels,
            "the pixels have a surface but no usable normal (zero, NaN, infinite or a thousand times too long); it is rebuilt "
            "from depth there "
            "(--normal names another channel)");
    warn_of(b, "bad-colours", atomic_load(&b->defects.colours), b->defects.colour_samples,
            "the colour samples are NaN or infinite; they count as black or as the largest value there is (--albedo, "
            "--beauty name other channels)");
    warn_of(b, "negative-albedo", atomic_load(&b->defects.negative_albedo), 3 * pixels,
            "the albedo's samples are negative; they count as black (--albedo names another channel)");
}
