// The header attribute ssdo/args: settings that change pixels and differ from their default, as one would type them.
#include <ctype.h>
#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/knobs.h"
#include "base/mem.h"
#include "cli/options.h"
#include "cli/options_table.h"

typedef struct record {
    char *buf; // grows
    size_t used, capacity;
    error *e;
    bool failed;
} record;

static void put(record *r, const char *text, size_t n)
{
    if (r->used + n + 1 > r->capacity) {
        size_t capacity = 2 * (r->used + n + 1);
        char *grown = r->failed ? NULL : mem_grow(r->buf, capacity, 1, r->e);
        r->failed = !grown;
        if (r->failed) return;
        r->buf = grown;
        r->capacity = capacity;
    }
    memcpy(r->buf + r->used, text, n);
    r->used += n;
    r->buf[r->used] = '\0';
}

static void put_string(record *r, const char *text) { put(r, text, strlen(text)); }

// In single quotes where a POSIX shell would need them.
static void put_value(record *r, const char *text)
{
    bool plain = *text != '\0';
    for (const char *p = text; *p; p++) plain = plain && (isalnum((unsigned char)*p) || strchr("_-+.,:/=@%", *p));
    if (plain) {
        put_string(r, text);
        return;
    }
    put_string(r, "'");
    for (const char *p = text; *p; p++) {
        if (*p == '\'')
            put_string(r, "'\\''");
        else
            put(r, p, 1);
    }
    put_string(r, "'");
}

// The first of 15, 16, 17 digits that reads back as the same double. The caller has put the thread into the C locale.
static void number_text(double v, char *buf, size_t size)
{
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(buf, size, "%.*g", digits, v);
        if (strtod(buf, NULL) == v) return;
    }
}

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash && slash[1] ? slash + 1 : path;
}

// The value of a row as text, or NULL when it has none. buf is scratch.
static const char *value_text(const option_row *row, const options *o, char *buf, size_t size)
{
    const char *field = (const char *)o + row->offset;
    double v = 0;
    if (row->kind == OPT_PATHS) return NULL; // several: put_row; the digest holds their content
    if (row->kind == OPT_FLAG) return *(const bool *)field ? "" : NULL;
    if (row->kind == OPT_RADIUS) {
        if (o->radius_unit == RADIUS_AUTO) return "auto";
        number_text(o->radius, buf, size);
        if (o->radius_unit == RADIUS_PIXELS) strcat(buf, "px");
        return buf;
    }
    if (row->kind == OPT_RANGE) {
        double range[2];
        memcpy(range, field, sizeof range);
        if (!(range[1] > 0.0)) return NULL;
        number_text(range[0], buf, size);
        size_t n = strlen(buf);
        buf[n] = ',';
        number_text(range[1], buf + n + 1, size - n - 1);
        return buf;
    }
    if (row->kind == OPT_TEXT || row->kind == OPT_PATH) {
        const char *text;
        memcpy(&text, field, sizeof text);
        return text && row->kind == OPT_PATH ? base_name(text) : text;
    }
    if (row->kind == OPT_REAL) {
        memcpy(&v, field, sizeof v);
    } else if (row->kind == OPT_SWITCH) {
        v = *(const bool *)field ? 1 : 0;
    } else {
        int i;
        memcpy(&i, field, sizeof i);
        v = i;
    }
    const char *word = word_of(row->words, v);
    if (word || row->kind == OPT_ENUM) return word; // none: not given
    number_text(v, buf, size);
    return buf;
}

static void put_option(record *r, const option_row *row, const char *value)
{
    if (r->used) put_string(r, " ");
    put_string(r, "--");
    put_string(r, row->name);
    if (row->kind == OPT_FLAG) return;
    put_string(r, strncmp(value, "--", 2) == 0 ? "=" : " "); // which would be taken for the next option
    put_value(r, value);
}

static bool same(const char *a, const char *b) { return a == b || (a && b && strcmp(a, b) == 0); }

static void put_row(record *r, const option_row *row, const options *o, const options *defaults)
{
    char buf[64], default_buf[64];
    if (row->kind == OPT_PATHS) {
        path_list list;
        memcpy(&list, (const char *)o + row->offset, sizeof list);
        for (int i = 0; i < list.count; i++) put_option(r, row, base_name(list.path[i]));
        return;
    }
    const char *value = value_text(row, o, buf, sizeof buf);
    if (!value || same(value, value_text(row, defaults, default_buf, sizeof default_buf))) return;
    put_option(r, row, value);
}

// As a shell takes it, before the command.
static void put_knob(record *r, const knob *k, const char *value)
{
    const char *slash = k->path ? strrchr(value, '/') : NULL;
    if (r->used) put_string(r, " ");
    put_string(r, k->name);
    put_string(r, "=");
    put_value(r, slash ? slash + 1 : value);
}

// Puts the calling thread into the C locale; the way back by leave_c_locale.
typedef struct c_locale {
    locale_t made, before;
} c_locale;

static bool enter_c_locale(c_locale *l, error *e)
{
    *l = (c_locale){0};
    l->made = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (!l->made) return err_set(e, ERR_MEMORY, NULL, NULL, "out of memory");
    l->before = uselocale(l->made);
    return true;
}

static void leave_c_locale(const c_locale *l)
{
    uselocale(l->before);
    freelocale(l->made);
}

char *options_record(const options *o, error *e)
{
    record r = {.e = e};
    options defaults;
    c_locale l;
    if (!enter_c_locale(&l, e)) return NULL;
    options_defaults(&defaults);
    put(&r, "", 0);
    for (const knob *k = knobs; k->name; k++)
        if (k->pixels && knob_value(k->name)) put_knob(&r, k, knob_value(k->name));
    for (int i = 0; i < option_row_count; i++)
        if (option_rows[i].pixels) put_row(&r, &option_rows[i], o, &defaults);
    leave_c_locale(&l);
    if (!r.failed) return r.buf;
    free(r.buf);
    return NULL;
}

// Defaults too: another version may have others.
bool options_digest(const options *o, digester *d, error *e)
{
    char buf[64];
    c_locale l;
    if (!enter_c_locale(&l, e)) return false;
    for (int i = 0; i < option_row_count; i++) {
        const option_row *row = &option_rows[i];
        if (!row->pixels && !row->bytes) continue;
        digest_put_text(d, row->name);
        digest_put_text(d, value_text(row, o, buf, sizeof buf));
    }
    for (const knob *k = knobs; k->name; k++) {
        if (!k->pixels || !knob_value(k->name)) continue;
        digest_put_text(d, k->name);
        digest_put_text(d, knob_value(k->name));
    }
    leave_c_locale(&l);
    return true;
}
