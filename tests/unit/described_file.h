// Files made of names alone, for tests of what serves which role. To be included after cmocka.h.
#ifndef SSDO_TESTS_DESCRIBED_FILE_H
#define SSDO_TESTS_DESCRIBED_FILE_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gbuffer/resolve.h"

enum { MOST = 40 };
static char text[4096];
static exrio_channel channels[MOST];
static exrio_part parts[8];
static exrio_file file;

// "part: a.R b.R; part: c.R", channels parted by commas, parts by semicolons, "part@view" for a view.
static inline const exrio_file *with(const char *description)
{
    snprintf(text, sizeof text, "%s", description);
    memset(channels, 0, sizeof channels);
    memset(parts, 0, sizeof parts);
    file = (exrio_file){.parts = parts};
    static char path[] = "in.exr", empty[] = "";
    file.path = path;
    int c = 0;
    char *rest = text, *part;
    while ((part = strsep(&rest, ";"))) {
        exrio_part *p = &parts[file.part_count++];
        p->name = p->view = empty;
        p->channels = &channels[c];
        char *colon = strchr(part, ':');
        if (colon) {
            *colon = 0;
            p->name = part, part = colon + 1;
            char *at = strchr(p->name, '@');
            if (at) *at = 0, p->view = at + 1;
        }
        char *name;
        while ((name = strsep(&part, ","))) {
            assert_true(c < MOST);
            channels[c++] = (exrio_channel){.name = name, .type = SAMPLE_FLOAT};
            p->channel_count++;
        }
    }
    return &file;
}

static inline resolution resolved(const char *description, const resolve_options *options)
{
    resolution r;
    error e = {0};
    resolve_options none = {0};
    if (!resolve_channels(with(description), options ? options : &none, &r, NULL, &e)) fail_msg("%s", e.message);
    return r;
}

static inline const char *name_of(const resolution *r, role which, int component)
{
    if (component >= r->components[which]) return "";
    channel_ref c = r->channels[which][component];
    return parts[c.part].channels[c.channel].name;
}

static inline void check(const resolution *r, role which, const char *first) { assert_string_equal(name_of(r, which, 0), first); }

static inline const char *title_of(const resolution *r, role which)
{
    static char line[300];
    resolve_describe(&file, r, which, line, sizeof line);
    return line;
}

#endif
