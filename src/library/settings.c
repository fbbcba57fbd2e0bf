#include "library/settings.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "cli/options_table.h"

// Of the options about a run, those that a caller may want; the others name outputs, list frames or print.
static const char *const of_a_run[] = {"device", "require-gpu", "gpu-debug", "threads", "strict"};

static bool is_setting(const option_row *row)
{
    for (size_t i = 0; i < sizeof of_a_run / sizeof *of_a_run; i++)
        if (strcmp(row->name, of_a_run[i]) == 0) return true;
    return row->group != GROUP_RUN && strcmp(row->name, "output") != 0;
}

static const option_row *find_row(const char *name, error *e)
{
    for (int i = 0; name && i < option_row_count; i++)
        if (strcmp(option_rows[i].name, name) == 0 && is_setting(&option_rows[i])) return &option_rows[i];
    err_set(e, ERR_USAGE, NULL, NULL, "there is no setting '%s'; settings are the options of ssdo-filter(1) without dashes",
            name ? name : "");
    return NULL;
}

// The settings in force as a command line of the program's, the oldest first; input and output have their place in the calls.
bool settings_parse(const ssdo_context *c, options *o, error *e)
{
    int count = 0;
    for (const setting *s = c->settings; s; s = s->next) count += !s->gone;
    char **argv = mem_zero((size_t)count + 5, sizeof *argv, e);
    if (!argv) return false;
    static char words[][7] = {"ssdo", "-o", "frame", "--", "frame"};
    int at = 1 + count;
    argv[0] = words[0];
    for (const setting *s = c->settings; s; s = s->next)
        if (!s->gone) argv[--at] = s->text;
    for (int i = 1; i < 5; i++) argv[count + i] = words[i];
    bool ok = options_parse(count + 5, argv, o, e);
    free(argv);
    o->hosted = o->literal = true;
    o->inputs[0] = NULL, o->input_count = 0, o->output = NULL;
    return ok;
}

static setting *make(const option_row *row, const char *value, error *e)
{
    size_t size = strlen(row->name) + strlen(value) + 4;
    setting *s = mem_zero(1, sizeof *s, e);
    char *text = mem_zero(size, 1, e);
    if (!s || !text) {
        free(s);
        free(text);
        return NULL;
    }
    bool flag = row->kind == OPT_FLAG;
    snprintf(text, size, flag ? "--%s" : "--%s=%s", row->name, value);
    *s = (setting){.text = text, .name = row->name};
    return s;
}

bool settings_make(ssdo_context *c, const char *name, const char *value, error *e)
{
    const option_row *row = find_row(name, e);
    if (!row) return false;
    if (row->kind == OPT_FLAG && value && value[0] && strcmp(value, "1") != 0)
        return err_set(e, ERR_USAGE, NULL, NULL, "the setting '%s' is on with \"1\" and off with NULL, not '%s'", name, value);
    setting *earlier = c->settings, *made = NULL;
    while (earlier && (earlier->gone || earlier->name != row->name)) earlier = earlier->next;
    if (value && !(made = make(row, value, e))) return false;
    if (earlier) earlier->gone = true;
    if (made) made->next = c->settings, c->settings = made;
    options o;
    if (settings_parse(c, &o, e)) {
        c->o = o;
        return true;
    }
    if (earlier) earlier->gone = false;
    if (made) {
        c->settings = made->next;
        free(made->text);
        free(made);
    }
    return false;
}

void settings_free(ssdo_context *c)
{
    while (c->settings) {
        setting *s = c->settings;
        c->settings = s->next;
        free(s->text);
        free(s);
    }
}
