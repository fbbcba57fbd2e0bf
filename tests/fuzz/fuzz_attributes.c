// libFuzzer target: what other programs may have stored in a header. The input is text, an attribute a line: "type name value";
// a first line "points" gives the file positions.
// The header is put together here, byte by byte, so that any type, name and number can stand in it. Whatever looks at attributes
// looks at it; what the file has is also in a copy that the program writes.
#include <OpenEXR/openexr.h>
#include <math.h>

#include "exr/file.h"
#include "exr/internal.h"
#include "exr/write.h"
#include "fuzz.h"
#include "gbuffer/gbuffer.h"
#include "gbuffer/resolve.h"

enum { MOST = 32, W = 4, H = 3, CHANNELS = 7, NUMBERS = 16, BYTES = 1 << 16 };

typedef struct bytes {
    uint8_t at[BYTES];
    size_t used;
} bytes;

static void put(bytes *b, const void *data, size_t size)
{
    CHECK(b->used + size <= BYTES);
    if (size) memcpy(b->at + b->used, data, size);
    b->used += size;
}

static void put_int(bytes *b, int32_t v) { put(b, &v, sizeof v); }
static void put_text(bytes *b, const char *text) { put(b, text, strlen(text) + 1); }

static void begin(bytes *b, const char *name, const char *type, size_t size)
{
    put_text(b, name);
    put_text(b, type);
    put_int(b, (int32_t)size);
}

typedef struct numeric {
    const char *type;
    int count;
    char element; // i: int, f: float, d: double
} numeric;

static const numeric numerics[] = {
    {"float", 1, 'f'}, {"double", 1, 'd'},         {"int", 1, 'i'},      {"v2f", 2, 'f'},      {"v2i", 2, 'i'},
    {"v3f", 3, 'f'},   {"m33f", 9, 'f'},           {"m44f", 16, 'f'},    {"m44d", 16, 'd'},    {"box2i", 4, 'i'},
    {"box2f", 4, 'f'}, {"chromaticities", 8, 'f'}, {"rational", 2, 'i'}, {"timecode", 2, 'i'}, {"keycode", 7, 'i'},
};

static void put_number(bytes *b, char element, double v)
{
    float f = (float)v;
    if (element == 'd')
        put(b, &v, sizeof v);
    else if (element == 'f')
        put(b, &f, sizeof f);
    else
        put_int(b, fabs(v) < 2e9 ? (int32_t)v : INT32_MIN);
}

static bool put_numeric(bytes *b, const char *type, const char *name, const char *value)
{
    for (size_t k = 0; k < sizeof numerics / sizeof *numerics; k++) {
        const numeric *n = &numerics[k];
        if (strcmp(type, n->type) != 0) continue;
        begin(b, name, type, (size_t)n->count * (n->element == 'd' ? 8 : 4));
        for (int i = 0; i < n->count; i++) {
            char *end;
            double v = strtod(value, &end);
            value = end;
            put_number(b, n->element, v);
        }
        return true;
    }
    return false;
}

// The strings stand with '|' between them.
static void put_strings(bytes *b, const char *name, const char *value)
{
    size_t parts = 1;
    for (const char *p = value; *p; p++) parts += *p == '|';
    begin(b, name, "stringvector", strlen(value) - (parts - 1) + 4 * parts);
    for (const char *at = value, *end; at; at = end) {
        size_t n = strcspn(at, "|");
        end = at[n] ? at + n + 1 : NULL;
        put_int(b, (int32_t)n);
        put(b, at, n);
    }
}

// "type name value"; a type of no numbers has the text as its bytes.
static const char *put_line(bytes *b, char *line)
{
    char *name = strchr(line, ' '), *value = name ? strchr(name + 1, ' ') : NULL;
    if (!value || name == line || value == name + 1 || value - line > 400) return NULL;
    *name++ = '\0', *value++ = '\0';
    if (put_numeric(b, line, name, value)) return name;
    if (strcmp(line, "stringvector") == 0) {
        put_strings(b, name, value);
    } else {
        begin(b, name, line, strlen(value));
        put(b, value, strlen(value));
    }
    return name;
}

static void put_channels(bytes *b, int count)
{
    static const char all[CHANNELS][8] = {"N.X", "N.Y", "N.Z", "P.X", "P.Y", "P.Z", "Z"};
    size_t size = 1;
    for (int c = 0; c < count; c++) size += strlen(all[c < count - 1 ? c : CHANNELS - 1]) + 1 + 16;
    begin(b, "channels", "chlist", size);
    for (int c = 0; c < count; c++) {
        put_text(b, all[c < count - 1 ? c : CHANNELS - 1]);
        put_int(b, EXR_PIXEL_FLOAT);
        put_int(b, 0);
        put_int(b, 1);
        put_int(b, 1);
    }
    put(b, "", 1);
}

// What every file must have.
static void put_required(bytes *b, int channels)
{
    put_int(b, 0x01312f76);
    put_int(b, 2 | 0x400); // long names
    put_channels(b, channels);
    begin(b, "compression", "compression", 1);
    put(b, "", 1);
    put_numeric(b, "box2i", "dataWindow", "0 0 3 2");
    put_numeric(b, "box2i", "displayWindow", "0 0 3 2");
    begin(b, "lineOrder", "lineOrder", 1);
    put(b, "", 1);
    put_numeric(b, "float", "pixelAspectRatio", "1");
    put_numeric(b, "v2f", "screenWindowCenter", "0 0");
    put_numeric(b, "float", "screenWindowWidth", "1");
}

// A plane across the view, 3 units away, seen at 90 degrees.
static float sample(int channel, int channels, int x, int y)
{
    const float at[3] = {3.0f * (float)(2 * x + 1 - W) / W, 3.0f * (float)(H - 2 * y - 1) / W, -3.0f};
    if (channel == channels - 1) return 3.0f;
    return channel < 3 ? (channel == 2 ? 1.0f : 0.0f) : at[channel - 3];
}

static void put_pixels(bytes *b, int channels)
{
    const size_t line = (size_t)channels * W * sizeof(float) + 8;
    put(b, "", 1);
    uint64_t first = b->used + H * sizeof(uint64_t);
    for (size_t y = 0; y < H; y++) put(b, &(uint64_t){first + y * line}, sizeof first);
    for (int y = 0; y < H; y++) {
        put_int(b, y);
        put_int(b, (int32_t)line - 8);
        for (int c = 0; c < channels; c++)
            for (int x = 0; x < W; x++) put_number(b, 'f', (double)sample(c, channels, x, y));
    }
}

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
}

// The camera comes out of attributes, if there is one in them.
static void build(exrio_file *f)
{
    error e = {0};
    resolution r;
    gbuffer g;
    log_t log;
    log_init(&log, LOG_QUIET);
    bool ok = resolve_channels(f, &(resolve_options){0}, &r, &log, &e);
    check_error(ok, &e);
    for (int c = 0; c < f->parts[0].channel_count; c++) f->parts[0].channels[c].wanted = true;
    if (ok) check_error(ok = exrio_file_load(f, 1, &e), &e);
    if (ok) check_error(ok = gbuffer_build(f, &r, &(gbuffer_options){.threads = 1}, &g, &log, &e), &e);
    if (ok) {
        CHECK(isfinite(g.camera.fx) && isfinite(g.camera.fy) && isfinite(g.camera.cx) && isfinite(g.camera.cy));
        gbuffer_free(&g);
    }
    log_free(&log);
}

// A part of our own takes the attributes over, except those that say how the other file is laid out.
static void copy(const exrio_file *f, const char **names, int count)
{
    static char path[64];
    static float z[W * H];
    if (!path[0]) snprintf(path, sizeof path, "/dev/shm/ssdo-fuzz-%d.exr", (int)getpid());
    exrio_out_channel channel = {"Z", SAMPLE_FLOAT, z};
    exrio_out_part part = {.data_window = {0, 0, W - 1, H - 1},
                           .display_window = {0, 0, W - 1, H - 1},
                           .pixel_aspect = 1.0f,
                           .compression = EXR_COMPRESSION_NONE,
                           .channels = &channel,
                           .channel_count = 1,
                           .attributes_from = f};
    error e = {0};
    exrio_file *written = NULL;
    bool ok = exrio_write(path, &part, 1, 1, &e);
    check_error(ok, &e);
    if (ok) CHECK(exrio_file_open(path, &written, &e));
    for (int i = 0; ok && i < count; i++)
        CHECK(exrio_attr_structural(names[i]) || exrio_attr_exists(written, 0, names[i]) || !exrio_attr_exists(f, 0, names[i]));
    exrio_file_close(written);
    unlink(path);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static int fd = -1;
    static bytes b;
    char path[64], *rest, *text = fuzz_text(data, size, &rest);
    const char *names[MOST];
    int count = 0;
    bool lists = false;
    b.used = 0;
    // Positions have a camera fitted to them, which takes its time.
    int channels = strncmp(text, "points\n", 7) == 0 ? CHANNELS : CHANNELS - 3;
    put_required(&b, channels);
    for (char *at = text, *end; at && count < MOST; at = end) {
        end = strchr(at, '\n');
        if (end) *end++ = '\0';
        const char *name = put_line(&b, at);
        if (name) names[count++] = name;
        if (name) lists |= strcmp(at, "chlist") == 0; // which is not copied
    }
    put_pixels(&b, channels);
    fuzz_file(&fd, path, b.at, b.used);
    exrio_file *f = NULL;
    error e = {0};
    bool ok = exrio_file_open(path, &f, &e);
    check_error(ok, &e);
    for (int i = 0; ok && i < count; i++) look(f, names[i]);
    if (ok) copy(f, names, lists ? 0 : count);
    if (ok) build(f);
    exrio_file_close(f);
    free(text);
    return 0;
}
