// libFuzzer target: a command line, one argument a line; what is accepted is in the bounds that the table promises, and its
// record is one line of text that says the same when it is made again.
#include <math.h>

#include "cli/frames.h"
#include "cli/options.h"
#include "fuzz.h"

enum { MOST = 64 };

static void check_options(const options *o)
{
    const double numbers[] = {o->radius,    o->scale,      o->contrast,          o->bounce_strength,
                              o->env_scale, o->env_rotate, o->depthmask_strength};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        CHECK(numbers[i] == 0.0 || (fabs(numbers[i]) >= 1e-15 && fabs(numbers[i]) <= 1e15));
    char a[8192], b[8192];
    options_record(o, a, sizeof a);
    options_record(o, b, sizeof b);
    CHECK(memchr(a, 0, sizeof a) && strcmp(a, b) == 0);
    frame_list list = {0};
    error e = {0};
    if (!o->frames) return;
    bool ok = frames_parse(o->frames, &list, &e);
    check_error(ok, &e);
    if (ok) frames_free(&list);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *rest, *text = fuzz_text(data, size, &rest), *argv[MOST + 2] = {"ssdo-filter"};
    int argc = 1;
    for (char *at = text, *end; argc <= MOST && at; at = end) {
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
