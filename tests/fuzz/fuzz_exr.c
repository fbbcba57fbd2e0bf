// libFuzzer target: a file's bytes through everything that reads them before the GPU: header, channels, pixels, camera, surfaces.
//
// What must hold whatever the bytes are: an error with a sentence, or a G-buffer that keeps gbuffer.h's contract. Memory, time
// and undefined behaviour are the sanitizers' and libFuzzer's own business (-rss_limit_mb, -timeout).
#include <math.h>

#include "base/content.h"
#include "exr/file.h"
#include "fuzz.h"
#include "gbuffer/gbuffer.h"
#include "gbuffer/resolve.h"

static void check_colours(const float *values, size_t n)
{
    for (size_t i = 0; values && i < n; i++) CHECK(isfinite(values[i]));
}

static void check_contract(const gbuffer *g)
{
    size_t n = (size_t)g->width * (size_t)g->height, valid = 0;
    for (size_t i = 0; i < n; i++) {
        const float *m = g->normal + 4 * i;
        float length = sqrtf(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
        CHECK(g->depth[i] >= 0.0f && isfinite(g->depth[i]));
        if (g->depth[i] > 0.0f) CHECK(fabsf(length - 1.0f) < 1e-3f);
        CHECK(isfinite(length));
        valid += g->depth[i] > 0.0f;
        if (g->coverage) CHECK(g->coverage[i] >= 0.0f && g->coverage[i] <= 1.0f);
    }
    CHECK(valid == g->valid);
    check_colours(g->albedo, 4 * n);
    check_colours(g->beauty, 4 * n);
    check_colours(g->material, 2 * n);
    check_colours(g->emission, 4 * n);
    CHECK(isfinite(g->extent) && g->extent >= 0.0);
}

static bool read_frame(const char *path, error *e)
{
    exrio_file *f = NULL;
    resolution r;
    gbuffer g;
    bool ok = false;
    log_t log;
    log_init(&log, LOG_QUIET);
    if (!exrio_file_open(path, &f, e)) goto out;
    // The last eye of a stereo file, if it is one.
    const exrio_part *first = &f->parts[0];
    resolve_options ro = {.view = first->view_count ? first->views[first->view_count - 1] : NULL};
    bool resolved = resolve_channels(f, &ro, &r, &log, e);
    for (int p = 0; p < f->part_count; p++)
        for (int c = 0; c < f->parts[p].channel_count; c++) f->parts[p].channels[c].wanted = true;
    if (!resolved || !exrio_file_load(f, 1, e)) goto out;
    gbuffer_options o = {.need = NEED_ALBEDO | NEED_BEAUTY | NEED_MATERIAL | NEED_EMISSION | NEED_DIFFUSE_LIGHT | NEED_COVERAGE,
                         .fov = r.components[ROLE_POSITION] ? 0.0 : 50.0,
                         .threads = 1};
    ok = gbuffer_build(f, &r, &o, &g, &log, e);
    if (ok) {
        check_contract(&g);
        gbuffer_free(&g);
    }
out:
    exrio_file_close(f);
    log_free(&log);
    return ok;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static int fd = -1;
    char path[64];
    fuzz_file(&fd, path, data, size);
    error e = {0};
    content c;
    CHECK(content_read(path, exrio_head_bytes, true, &c, &e)); // what --skip-existing looks at
    CHECK(!digest_equal(c.exact, (digest){0}));
    if (!read_frame(path, &e)) CHECK(e.code != ERR_NONE && e.message[0]);
    return 0;
}
