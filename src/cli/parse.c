#include "cli/options.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/names.h"
#include "cli/options_table.h"

#define SEE_HELP "see ssdo-filter --help"

void options_defaults(options *o)
{
    *o = (options){
        .method = "arc",
        .radius_unit = RADIUS_AUTO,
        .thickness = -1,
        .outside = -1,
        .blur = -1,
        .resolution = RESOLUTION_BY_QUALITY,
        .mesh_axes = -1,
        .scale = 1,
        .contrast = 1,
        .bounce_strength = 1,
        .vpl_count = 512,
        .sh_bands = 2,
        .env_scale = 1,
        .beauty_env_scale = 1,
        .env_lod = -1,
        .mode = MODE_RADIANCE,
        .amount = 1,
        .normal_encoding = NORMAL_AUTO,
        .prefix = "",
        .device = -1,
        .preview_every = 1,
        .radius_from = INT_MIN,
    };
}

// ---- values

// The whole of `text` as a finite number. strtod_l with the C locale, because the process may run in one with a decimal comma.
static bool read_number(const char *text, double *value)
{
    locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (!c) return false;
    char *end;
    double v = strtod_l(text, &end, c);
    freelocale(c);
    if (end == text || *end || isspace((unsigned char)*text) || !isfinite(v)) return false;
    *value = v;
    return true;
}

static const option_word *find_word(const option_row *row, const char *text)
{
    for (const option_word *w = row->words; w && w->text; w++)
        if (strcmp(w->text, text) == 0) return w;
    return NULL;
}

// "auto, inf or " or, with no number to follow, "all or none".
static void list_words(const option_row *row, bool number_follows, char *buf, size_t size)
{
    buf[0] = '\0';
    for (const option_word *w = row->words; w && w->text; w++) {
        size_t n = strlen(buf);
        bool last = !w[1].text;
        const char *gap = last ? (number_follows ? " or " : "") : (w[2].text || number_follows ? ", " : " or ");
        snprintf(buf + n, size - n, "%s%s", w->text, gap);
    }
}

// What a number must be: "a whole number from 1 to 65536".
static void describe_number(const option_row *row, char *buf, size_t size)
{
    const char *noun = row->kind == OPT_INT ? "a whole number" : "a number";
    bool below = isfinite(row->min), above = isfinite(row->max);
    if (below && above && row->open)
        snprintf(buf, size, "%s greater than %.0f and less than %.0f", noun, row->min, row->max);
    else if (below && above)
        snprintf(buf, size, "%s from %.0f to %.0f", noun, row->min, row->max);
    else if (below)
        snprintf(buf, size, "%s %s %.0f", noun, row->open ? "greater than" : "of at least", row->min);
    else
        snprintf(buf, size, "%s", noun);
}

static bool fail_value(const option_row *row, const char *text, error *e)
{
    bool number = row->kind == OPT_INT || row->kind == OPT_REAL;
    char words[256], range[128] = "";
    list_words(row, number, words, sizeof words);
    if (number) describe_number(row, range, sizeof range);
    return err_set(e, ERR_USAGE, NULL, NULL, "--%s must be %s%s, not '%s'; " SEE_HELP, row->name, words, range, text);
}

// Numbers end up in shaders, in single precision: this leaves room for their squares and for products with radiances.
static bool fits_single(const char *name, const char *text, double v, error *e)
{
    if (v == 0.0 || (fabs(v) >= 1e-15 && fabs(v) <= 1e15)) return true;
    return err_set(e, ERR_USAGE, NULL, NULL, "--%s %s is beyond what is computed with (1e-15 to 1e15); " SEE_HELP, name, text);
}

static bool in_range(const option_row *row, double v)
{
    return row->open ? v > row->min && v < row->max : v >= row->min && v <= row->max;
}

static bool set_number(const option_row *row, const char *text, void *field, error *e)
{
    const option_word *word = find_word(row, text);
    double v;
    if (word)
        v = word->value;
    else if (!read_number(text, &v) || !in_range(row, v) || (row->kind == OPT_INT && v != trunc(v)))
        return fail_value(row, text, e);
    if (!word && !fits_single(row->name, text, v, e)) return false;
    if (row->kind == OPT_INT) {
        int i = (int)v;
        memcpy(field, &i, sizeof i);
    } else {
        memcpy(field, &v, sizeof v);
    }
    return true;
}

static bool set_radius(const char *text, options *o, error *e)
{
    if (strcmp(text, "auto") == 0) {
        o->radius_unit = RADIUS_AUTO;
        o->radius = 0;
        return true;
    }
    char number[64];
    size_t n = strlen(text);
    bool pixels = n > 2 && strcmp(text + n - 2, "px") == 0;
    if (pixels) n -= 2;
    double v = 0;
    if (n < sizeof number) {
        memcpy(number, text, n);
        number[n] = '\0';
        if (read_number(number, &v) && v > 0) {
            if (!fits_single("radius", text, v, e)) return false;
            o->radius = v;
            o->radius_unit = pixels ? RADIUS_PIXELS : RADIUS_WORLD;
            return true;
        }
    }
    return err_set(
        e, ERR_USAGE, NULL, NULL,
        "--radius must be auto, a length greater than 0 in scene units (0.25) or one in pixels (40px), not '%s'; " SEE_HELP,
        text);
}

// "NEAR,FAR".
static bool set_range(const option_row *row, const char *text, double field[2], error *e)
{
    char first[64];
    const char *comma = strchr(text, ',');
    double v[2];
    size_t n = comma ? (size_t)(comma - text) : 0;
    snprintf(first, sizeof first, "%.*s", (int)(n < sizeof first ? n : 0), text);
    if (!comma || !read_number(first, &v[0]) || !read_number(comma + 1, &v[1]) || !(v[0] >= 0.0 && v[1] > v[0]))
        return err_set(e, ERR_USAGE, NULL, NULL,
                       "--%s must be two numbers of at least 0, the second the larger one, not '%s'; " SEE_HELP, row->name, text);
    memcpy(field, v, sizeof v);
    return true;
}

static bool set_text(const option_row *row, const char *text, void *field, error *e)
{
    if (!*text && !row->may_be_empty)
        return err_set(e, ERR_USAGE, NULL, NULL, "--%s needs a value that is not empty; " SEE_HELP, row->name);
    memcpy(field, &text, sizeof text);
    return true;
}

static bool add_path(const option_row *row, const char *text, path_list *field, error *e)
{
    if (field->count == OPT_MOST_PATHS)
        return err_set(e, ERR_USAGE, NULL, NULL, "--%s may be given %d times, not more", row->name, OPT_MOST_PATHS);
    return set_text(row, text, &field->path[field->count], e) && (field->count++, true);
}

static bool set_word(const option_row *row, const char *text, void *field, error *e)
{
    const option_word *word = find_word(row, text);
    if (!word) return fail_value(row, text, e);
    int i = (int)word->value;
    bool b = i != 0;
    if (row->kind == OPT_SWITCH)
        memcpy(field, &b, sizeof b);
    else
        memcpy(field, &i, sizeof i);
    return true;
}

// text is NULL for a flag.
static bool set_value(const option_row *row, const char *text, options *o, error *e)
{
    void *field = (char *)o + row->offset;
    switch (row->kind) {
    case OPT_FLAG:
        *(bool *)field = true;
        return true;
    case OPT_SWITCH:
    case OPT_ENUM:
        return set_word(row, text, field, e);
    case OPT_TEXT:
    case OPT_PATH:
        return set_text(row, text, field, e);
    case OPT_PATHS:
        return add_path(row, text, field, e);
    case OPT_INT:
    case OPT_REAL:
        return set_number(row, text, field, e);
    case OPT_RANGE:
        return set_range(row, text, field, e);
    case OPT_RADIUS:
        return set_radius(text, o, e);
    }
    return false;
}

// ---- names

static const option_row *find_name(const char *name, size_t length)
{
    for (int i = 0; i < option_row_count; i++)
        if (strlen(option_rows[i].name) == length && memcmp(option_rows[i].name, name, length) == 0) return &option_rows[i];
    return NULL;
}

static const option_row *find_letter(char letter)
{
    for (int i = 0; i < option_row_count; i++)
        if (letter && option_rows[i].letter == letter) return &option_rows[i];
    return NULL;
}

enum { NAME_MAX_LENGTH = 40 };

static int min3(int a, int b, int c)
{
    int m = a < b ? a : b;
    return m < c ? m : c;
}

// Edits between two names (Levenshtein).
static int distance(const char *a, int n, const char *b)
{
    int m = (int)strlen(b), d[NAME_MAX_LENGTH + 1][NAME_MAX_LENGTH + 1];
    if (n > NAME_MAX_LENGTH || m > NAME_MAX_LENGTH) return INT_MAX;
    for (int i = 0; i <= n; i++) d[i][0] = i;
    for (int j = 0; j <= m; j++) d[0][j] = j;
    for (int i = 1; i <= n; i++)
        for (int j = 1; j <= m; j++) d[i][j] = min3(d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1]));
    return d[n][m];
}

static const option_row *nearest(const char *name, int length)
{
    const option_row *best = &option_rows[0];
    int least = INT_MAX;
    for (int i = 0; i < option_row_count; i++) {
        // An abbreviation is not accepted, so that scripts keep working when options are added, but it is understood here.
        bool prefix = length >= 3 && strncmp(option_rows[i].name, name, (size_t)length) == 0;
        int d = prefix ? 1 : distance(name, length, option_rows[i].name);
        if (d < least) {
            least = d;
            best = &option_rows[i];
        }
    }
    return best;
}

static bool fail_unknown(const char *argument, error *e)
{
    const char *name = argument + strspn(argument, "-");
    int length = (int)strcspn(name, "=");
    int shown = (int)(name - argument) + length;
    if (length <= 1)
        return err_set(e, ERR_USAGE, NULL, NULL, "unknown option %.*s; the short options are -o, -v, -q and -h, " SEE_HELP, shown,
                       argument);
    return err_set(e, ERR_USAGE, NULL, NULL, "unknown option %.*s; the nearest one is --%s, " SEE_HELP, shown, argument,
                   nearest(name, length)->name);
}

// ---- the walk over argv

typedef struct walk {
    int argc, at;
    char **argv;
    options *o;
    error *e;
} walk;

// The value that follows in the next argument. One that is itself a known long option was meant as such: the value was forgotten.
// "-30" stays a value.
static const char *next_value(walk *w, const option_row *row)
{
    const char *value = w->at + 1 < w->argc ? w->argv[w->at + 1] : NULL;
    if (!value || (strncmp(value, "--", 2) == 0 && find_name(value + 2, strcspn(value + 2, "=")))) {
        char buf[OPTION_ARGUMENT];
        err_set(w->e, ERR_USAGE, NULL, NULL, "--%s needs a value: --%s %s; " SEE_HELP, row->name, row->name,
                option_argument(row, buf, sizeof buf));
        return NULL;
    }
    w->at++;
    return value;
}

static bool parse_long(walk *w)
{
    const char *argument = w->argv[w->at], *name = argument + 2;
    size_t length = strcspn(name, "=");
    const char *value = name[length] == '=' ? name + length + 1 : NULL;
    const option_row *row = find_name(name, length);
    if (!row) return fail_unknown(argument, w->e);
    if (row->kind == OPT_FLAG && value && row->words) {
        if (!find_word(row, value)) return fail_value(row, value, w->e);
        *(bool *)((char *)w->o + row->word_offset) = true;
        value = NULL;
    }
    if (row->kind == OPT_FLAG && value)
        return err_set(w->e, ERR_USAGE, NULL, NULL, "--%s takes no value, but '%s' was given; " SEE_HELP, row->name, value);
    if (row->kind != OPT_FLAG && !value && !(value = next_value(w, row))) return false;
    if (row->kind == OPT_RANGE && !strchr(value, ',')) {
        char both[160];
        const char *second = next_value(w, row);
        if (!second) return false;
        snprintf(both, sizeof both, "%.70s,%.70s", value, second);
        return set_value(row, both, w->o, w->e);
    }
    return set_value(row, value, w->o, w->e);
}

// "-v", "-vq", "-o FILE", "-oFILE".
static bool parse_short(walk *w)
{
    const char *argument = w->argv[w->at];
    for (const char *p = argument + 1; *p; p++) {
        const option_row *row = find_letter(*p);
        if (!row) return fail_unknown(argument, w->e);
        if (row->kind != OPT_FLAG) {
            const char *value = p[1] ? p + 1 : next_value(w, row);
            return value && set_value(row, value, w->o, w->e);
        }
        set_value(row, NULL, w->o, w->e);
    }
    return true;
}

static bool fail_pipe(const char *what, error *e)
{
    return err_set(e, ERR_USAGE, NULL, NULL,
                   "%s cannot be '-': nothing goes through a pipe; name a file (./- is one of that name)", what);
}

static bool add_input(walk *w)
{
    const char *argument = w->argv[w->at];
    if (!*argument) return err_set(w->e, ERR_USAGE, NULL, NULL, "an input file name is empty; " SEE_HELP);
    if (strcmp(argument, "-") == 0) return fail_pipe("the input", w->e);
    char pattern[512];
    if (w->o->input_count == OPT_MAX_INPUTS && names_are_frames(w->o->inputs[0], argument, pattern, sizeof pattern))
        return err_set(w->e, ERR_USAGE, argument, NULL, NAMES_SEQUENCE, pattern);
    if (w->o->input_count == OPT_MAX_INPUTS)
        return err_set(w->e, ERR_USAGE, NULL, NULL, "more than %d input files, from '%s' on; run the tool once per group",
                       OPT_MAX_INPUTS, argument);
    w->o->inputs[w->o->input_count++] = argument;
    return true;
}

// What no single row can know.
static bool check_together(const options *o, error *e)
{
    if (o->help || o->version || o->list_devices || o->completion) return true;
    if (o->input_count == 0)
        return err_set(e, ERR_USAGE, NULL, NULL, "no input file; usage: ssdo-filter [options] INPUT... -o OUTPUT, " SEE_HELP);
    if (!o->output && !o->explain) return err_set(e, ERR_USAGE, NULL, NULL, "no output file; name it with -o FILE, " SEE_HELP);
    const struct {
        const char *name, *path;
    } targets[] = {{"--output", o->output}, {"--preview", o->preview}, {"--report", o->report}};
    for (size_t i = 0; i < sizeof targets / sizeof *targets; i++)
        if (targets[i].path && strcmp(targets[i].path, "-") == 0) return fail_pipe(targets[i].name, e);
    if (o->output && !names_check_output(o->output, e)) return false;
    if (o->fov > 0 && o->ortho > 0)
        return err_set(e, ERR_USAGE, NULL, NULL, "--fov and --ortho exclude each other; give the one the camera has");
    if (o->verbose && o->quiet) return err_set(e, ERR_USAGE, NULL, NULL, "-v and -q exclude each other; give one");
    return true;
}

// The two parameter sets of the Alchemy chapter, as defaults: what is typed, before or after, counts.
static void preset_defaults(options *o, preset p)
{
    bool scene = p == PRESET_SCENE;
    options_defaults(o);
    o->method = "alchemy";
    o->radius_unit = RADIUS_WORLD;
    o->radius = scene ? 0.05 : 0.08;
    o->scale = scene ? 2.0 : 1.7;
    o->contrast = scene ? 3.0 : 2.2;
}

static bool walk_arguments(int argc, char **argv, options *o, error *e)
{
    walk w = {.argc = argc, .argv = argv, .o = o, .e = e};
    bool only_inputs = false;
    for (w.at = 1; w.at < argc; w.at++) {
        const char *a = argv[w.at];
        bool ok;
        if (!only_inputs && strcmp(a, "--") == 0) {
            only_inputs = true;
            continue;
        }
        if (only_inputs || a[0] != '-' || !a[1])
            ok = add_input(&w);
        else
            ok = a[1] == '-' ? parse_long(&w) : parse_short(&w);
        if (!ok) return false;
    }
    return true;
}

bool options_parse(int argc, char **argv, options *o, error *e)
{
    options_defaults(o);
    if (!walk_arguments(argc, argv, o, e)) return false;
    if (o->preset != PRESET_NONE) {
        preset_defaults(o, o->preset);
        if (!walk_arguments(argc, argv, o, e)) return false;
    }
    return check_together(o, e);
}
