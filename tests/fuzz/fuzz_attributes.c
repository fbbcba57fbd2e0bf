// libFuzzer target: what other programs may have stored in a header. A file is written with the input's bytes as attributes, one
// a line: "name text"; what is read back is what was stored, and everything that looks at attributes looks at it.
#include <OpenEXR/openexr.h>

#include "exr/file.h"
#include "exr/write.h"
#include "fuzz.h"
#include "gbuffer/camera_header.h"
#include "gbuffer/resolve.h"

enum { MOST = 32, W = 4, H = 3 };

static void look(const exrio_file *f, const char *name)
{
    const char *text, *list[EXRIO_VIEWS];
    double v[16], m[4][4];
    exrio_attr_string(f, 0, name, &text);
    exrio_attr_float(f, 0, name, v);
    exrio_attr_m44(f, 0, name, m);
    exrio_attr_v2(f, 0, name, v);
    exrio_attr_chromaticities(f, 0, v);
    exrio_attr_strings(f, 0, name, list, EXRIO_VIEWS);
    CHECK(exrio_attr_exists(f, 0, name));
}

static bool write_file(const char *path, exrio_out_attr *attributes, int count, error *e)
{
    static float z[W * H] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
    exrio_out_channel channels[] = {
        {"Z", SAMPLE_FLOAT, z}, {"N.X", SAMPLE_FLOAT, z}, {"N.Y", SAMPLE_FLOAT, z}, {"N.Z", SAMPLE_FLOAT, z}};
    exrio_out_part part = {.data_window = {0, 0, W - 1, H - 1},
                           .display_window = {0, 0, W - 1, H - 1},
                           .pixel_aspect = 1.0f,
                           .compression = EXR_COMPRESSION_NONE,
                           .channels = channels,
                           .channel_count = 4,
                           .attributes = attributes,
                           .attribute_count = count};
    return exrio_write(path, &part, 1, 1, e);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static char path[64];
    char *rest, *text = fuzz_text(data, size, &rest);
    exrio_out_attr attributes[MOST] = {0};
    int count = 0;
    if (!path[0]) snprintf(path, sizeof path, "/dev/shm/ssdo-fuzz-%d.exr", (int)getpid());
    for (char *at = text, *end; at && count < MOST; at = end) {
        end = strchr(at, '\n');
        if (end) *end++ = '\0';
        char *value = strchr(at, ' ');
        if (!value || value == at || value - at > 200) continue;
        *value++ = '\0';
        attributes[count++] = (exrio_out_attr){.name = at, .kind = EXRIO_OUT_STRING, .string = value};
    }
    error e = {0};
    if (write_file(path, attributes, count, &e)) {
        exrio_file *f = NULL;
        log_t log;
        resolution r;
        log_init(&log, LOG_QUIET);
        bool ok = exrio_file_open(path, &f, &e);
        check_error(ok, &e);
        for (int i = 0; ok && i < count; i++) look(f, attributes[i].name);
        resolve_options ro = {0};
        if (ok) check_error(resolve_channels(f, &ro, &r, &log, &e), &e);
        log_free(&log);
        exrio_file_close(f);
    } else {
        check_error(false, &e);
    }
    unlink(path);
    free(text);
    return 0;
}
