// libFuzzer target: a command line, one argument a line; what is accepted is in the bounds that the table promises, and its
// record, typed as a command line, is accepted and has the same record.
#include <math.h>

#include "cli/frames.h"
#include "cli/options.h"
#include "fuzz.h"

enum { MOST = 64 };

// Takes a shell's words out of `text`, in place.
static int split(char *text, char **words, int most)
{
    char *to = text;
    int count = 0;
    for (char *p = text; *p && count < most;) {
        words[count++] = to;
        for (bool quoted = false; *p && (quoted || *p != ' '); p++) {
            if (*p == '\\' && !quoted && p[1])
                *to++ = *++p;
            else if (*p == '\'')
                quoted = !quoted;
            else
                *to++ = *p;
        }
        p += *p == ' ';
        *to++ = '\0';
    }
    return count;
}

static void check_record(const options *o)
{
    char *argv[2 * MOST + 8] = {"ssdo-filter", "in.exr", "-o", "out.exr"};
    error e = {0};
    options again;
    char *record = options_record(o, &e), *words = record ? strdup(record) : NULL;
    CHECK(words);
    int argc = 4 + split(words, argv + 4, 2 * MOST);
    options_defaults(&again);
    if (!options_parse(argc, argv, &again, &e)) fprintf(stderr, "%s: %s\n", record, e.message);
    CHECK(e.code == ERR_NONE);
    char *second = options_record(&again, &e);
    if (second && strcmp(record, second) != 0) fprintf(stderr, "%s\n%s\n", record, second);
    CHECK(second && strcmp(record, second) == 0);
    free(record);
    free(words);
    free(second);
}

static void check_options(const options *o)
{
    const double numbers[] = {o->radius,    o->scale,      o->contrast,          o->bounce_strength,
                              o->env_scale, o->env_rotate, o->depthmask_strength};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        CHECK(numbers[i] == 0.0 || (fabs(numbers[i]) >= 1e-15 && fabs(numbers[i]) <= 1e15));
    frame_list list = {0};
    error e = {0};
    check_record(o);
    digester *d = digest_begin(&e);
    CHECK(d && options_digest(o, d, &e));
    digest_free(d);
    if (!o->frames) return;
    bool ok = frames_parse(o->frames, &list, &e);
    check_error(ok, &e);
    if (ok) frames_free(&list);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *rest, *text = fuzz_text(data, size, &rest), *argv[MOST + 2] = {"ssdo-filter"};
    int argc = 1;
    for (char *at = text, *end; argc <= MOST && at && *at; at = end) {
        end = strchr(at, '\n');
        if (end) *end++ = '\0';
        argv[argc++] = at;
    }
    options o;
    error e = {0};
    options_defaults(&o);
    bool ok = options_parse(argc, argv, &o, &e);
    check_error(ok, &e);
    if (ok) check_options(&o);
    free(text);
    return 0;
}
