#include "cli/frames.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/sort.h"

static bool add(frame_list *l, int frame, error *e)
{
    if (l->count == FRAMES_MAX) return err_set(e, ERR_USAGE, NULL, NULL, "--frames names more than %d frames", FRAMES_MAX);
    if ((l->count & (l->count - 1)) == 0) { // room doubles at powers of two
        int *grown = mem_grow(l->frames, l->count ? (size_t)l->count * 2 : 1, sizeof *grown, e);
        if (!grown) return false;
        l->frames = grown;
    }
    l->frames[l->count++] = frame;
    return true;
}

static const char *skip_spaces(const char *p)
{
    while (isspace((unsigned char)*p)) p++;
    return p;
}

static bool read_number(const char **p, int *value)
{
    char *end;
    errno = 0;
    const char *at = skip_spaces(*p);
    if (!isdigit((unsigned char)at[*at == '-'])) return false;
    long v = strtol(at, &end, 10);
    if (errno || v < -FRAMES_MAX * 100L || v > FRAMES_MAX * 100L) return false;
    *value = (int)v;
    *p = skip_spaces(end);
    return true;
}

// One item: first[-last[(x|:)step]].
static bool read_item(const char **p, frame_list *l, bool *syntax, error *e)
{
    int first, last, step = 1;
    *syntax = read_number(p, &first);
    last = first;
    if (*syntax && **p == '-') {
        ++*p;
        *syntax = read_number(p, &last);
        if (*syntax && (**p == 'x' || **p == ':')) {
            ++*p;
            *syntax = read_number(p, &step) && step != 0;
        }
    }
    if (!*syntax) return false;
    long stride = labs((long)step);
    for (long f = first; first <= last ? f <= last : f >= last; f += first <= last ? stride : -stride)
        if (!add(l, (int)f, e)) return false;
    return true;
}

static int by_frame(const void *a, const void *b)
{
    return (*(const int *)a > *(const int *)b) - (*(const int *)a < *(const int *)b);
}

// Keeps the first of equal frames, in the order given.
static bool drop_repeats(frame_list *l, error *e)
{
    int *sorted = mem_zero((size_t)l->count, sizeof *sorted, e);
    if (!sorted) return false;
    memcpy(sorted, l->frames, (size_t)l->count * sizeof *sorted);
    sort_ints(sorted, (size_t)l->count);
    bool repeats = false;
    for (int i = 1; i < l->count; i++) repeats |= sorted[i] == sorted[i - 1];
    int kept = 0;
    unsigned char *seen = repeats ? mem_zero((size_t)l->count, 1, e) : NULL; // by place in `sorted`
    for (int i = 0; repeats && seen && i < l->count; i++) {
        int *at = bsearch(&l->frames[i], sorted, (size_t)l->count, sizeof *sorted, by_frame);
        while (at > sorted && at[-1] == *at) at--;
        if (seen[at - sorted]++) continue;
        l->frames[kept++] = l->frames[i];
    }
    if (repeats && seen) l->count = kept;
    free(seen);
    free(sorted);
    return !repeats || kept > 0;
}

bool frames_parse(const char *text, frame_list *out, error *e)
{
    *out = (frame_list){0};
    const char *p = skip_spaces(text);
    bool syntax = *p != 0, ok = syntax;
    while (ok) {
        ok = read_item(&p, out, &syntax, e);
        if (!ok || *p != ',') break;
        p = p + 1;
    }
    if (ok && *p == '%') p += strspn(p, "%0123456789");
    if (ok && *p != 0) ok = syntax = false;
    if (!syntax)
        err_set(e, ERR_USAGE, NULL, NULL, "--frames: '%s' is not a frame range; write 1-100, 1-100x2, 1-10:4 or 1,5,7-9", text);
    if (ok) ok = drop_repeats(out, e);
    if (!ok) frames_free(out);
    return ok;
}

void frames_free(frame_list *l)
{
    free(l->frames);
    *l = (frame_list){0};
}

void frames_format(const frame_list *l, char *out, size_t size)
{
    static const char more[] = ", ...";
    size_t used = 0;
    out[0] = '\0';
    for (int i = 0, end; i < l->count; i = end) {
        char item[40];
        for (end = i + 1; end < l->count && l->frames[end] == l->frames[end - 1] + 1;) end++;
        if (end - i < 3) end = i + 1;
        int n = snprintf(item, sizeof item, end - i > 1 ? "%s%d-%d" : "%s%d", i ? ", " : "", l->frames[i], l->frames[end - 1]);
        bool last = end == l->count;
        if (used + (size_t)n + (last ? 1 : sizeof more) > size) {
            snprintf(out + used, size - used, "%s", more);
            return;
        }
        memcpy(out + used, item, (size_t)n + 1);
        used += (size_t)n;
    }
}

// Where the frame number goes: [begin, end) of the path, and its width (0: as many digits as it takes).
typedef struct place {
    size_t begin, end;
    int width;
} place;

// Length of a frame place at p (0: none), and its width.
static size_t place_at(const char *p, int *width)
{
    size_t n = 0;
    *width = 0;
    if (*p == '#') {
        while (p[n] == '#') n++;
        *width = (int)n;
        return n;
    }
    if (p[0] == '%') {
        n = 1 + strspn(p + 1, "0123456789");
        long digits = strtol(p + 1, NULL, 10);
        *width = (int)(digits < 20 ? digits : 0);
        return p[n] == 'd' && digits < 20 ? n + 1 : 0;
    }
    if (p[0] == '$' && p[1] == 'F') {
        n = 2 + (isdigit((unsigned char)p[2]) != 0);
        *width = n == 3 ? p[2] - '0' : 0;
        return n;
    }
    return 0;
}

static bool find_place(const char *path, place *out)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    bool found = false;
    for (const char *p = name; *p;) {
        int width;
        size_t n = place_at(p, &width);
        if (n) {
            *out = (place){(size_t)(p - path), (size_t)(p - path) + n, width};
            found = true;
        }
        p += n ? n : 1;
    }
    return found;
}

bool pattern_is(const char *path)
{
    place p;
    return find_place(path, &p);
}

bool pattern_path(const char *pattern, int frame, char *out, size_t size)
{
    place p;
    int n;
    if (!find_place(pattern, &p))
        n = snprintf(out, size, "%s", pattern);
    else
        n = snprintf(out, size, "%.*s%s%0*u%s", (int)p.begin, pattern, frame < 0 ? "-" : "", p.width,
                     frame < 0 ? 0u - (unsigned)frame : (unsigned)frame, pattern + p.end);
    return n >= 0 && (size_t)n < size;
}

// The frame number of a file name under the pattern's name part, if it is one.
static bool match(const char *name, const char *pattern_name, const place *p, int *frame)
{
    size_t head = p->begin, tail = strlen(pattern_name + p->end), n = strlen(name);
    if (n <= head + tail || strncmp(name, pattern_name, head) != 0 || strcmp(name + n - tail, pattern_name + p->end) != 0)
        return false;
    const char *digits = name + head, *end = name + n - tail;
    bool negative = *digits == '-';
    digits += negative;
    size_t count = (size_t)(end - digits);
    if (count == 0 || count > 9 || strspn(digits, "0123456789") < count) return false;
    // A number is longer than its width only when it has no padding.
    if (p->width && (count < (size_t)p->width || (count > (size_t)p->width && *digits == '0'))) return false;
    long v = strtol(digits, NULL, 10);
    *frame = (int)(negative ? -v : v);
    return true;
}

// A listing that ends early would be another sequence.
static bool list_folder(DIR *d, const char *folder, const char *pattern_name, const place *p, frame_list *out, error *e)
{
    for (;;) {
        int frame;
        errno = 0;
        struct dirent *entry = readdir(d);
        if (!entry) return !errno || err_set_system(e, ERR_INPUT, errno, folder, "the folder cannot be read");
        if (match(entry->d_name, pattern_name, p, &frame) && !add(out, frame, e)) return false;
    }
}

bool pattern_scan(const char *pattern, frame_list *out, error *e)
{
    place p;
    char folder[4096] = ".";
    *out = (frame_list){0};
    if (!find_place(pattern, &p)) return true;
    const char *slash = strrchr(pattern, '/');
    size_t skip = slash ? (size_t)(slash - pattern) + 1 : 0;
    if (slash) snprintf(folder, sizeof folder, "%.*s", (int)skip, pattern);
    p.begin -= skip;
    p.end -= skip;
    DIR *d = opendir(folder);
    bool ok =
        d || errno == ENOENT || errno == ENOTDIR || err_set_system(e, ERR_INPUT, errno, folder, "the folder cannot be read");
    if (d) {
        ok = list_folder(d, folder, pattern + skip, &p, out, e);
        closedir(d);
    }
    if (!ok) frames_free(out);
    if (out->count) sort_ints(out->frames, (size_t)out->count);
    return ok;
}
