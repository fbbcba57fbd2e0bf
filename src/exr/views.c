// Stereo views told by channel names: OpenEXR's single-part multi-view form (the attribute multiView; exrio_channel.view).
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "exr/internal.h"

// The place of the view's word in a name, or NULL. The component is not looked at, and of several places the last counts: OpenEXR
// puts the word before the component (layer.right.R), some writers put it in front (right.layer.R).
static const char *view_word(const char *name, const char *view)
{
    size_t n = strlen(view);
    const char *found = NULL;
    for (const char *word = name, *dot; (dot = strchr(word, '.')); word = dot + 1)
        if ((size_t)(dot - word) == n && strncmp(word, view, n) == 0) found = word;
    return found;
}

// A name of one word is the default view's; one of several without a view's word is nobody's own.
static const char *view_by_name(const exrio_part *p, const char *name)
{
    const char *best = NULL, *view = strchr(name, '.') ? NULL : p->views[0];
    for (int v = 0; v < p->view_count; v++) {
        const char *word = view_word(name, p->views[v]);
        if (word && (!best || word > best)) best = word, view = p->views[v];
    }
    return view;
}

void exrio_free_views(exrio_part *p)
{
    for (int v = 0; v < p->view_count; v++) free(p->views[v]);
    p->view_count = 0;
}

static void forget_views(exrio_part *p)
{
    for (int c = 0; c < p->channel_count; c++) p->channels[c].view = NULL;
    exrio_free_views(p);
}

static int views_with_channels(const exrio_part *p)
{
    int n = 0;
    for (int v = 0; v < p->view_count; v++)
        for (int c = 0; c < p->channel_count; c++)
            if (p->channels[c].view == p->views[v]) {
                n++;
                break;
            }
    return n;
}

bool exrio_fill_views(const exrio_file *file, int index, exrio_part *p, error *e)
{
    const char *names[EXRIO_VIEWS];
    int count = p->view[0] ? 0 : exrio_attr_strings(file, index, "multiView", names, EXRIO_VIEWS);
    for (int v = 0; v < count; v++) {
        size_t n = strlen(names[v]);
        if (n < 1 || n > EXRIO_SHORT_NAME || strchr(names[v], '.')) continue;
        if (!(p->views[p->view_count] = mem_string(names[v], e))) return false;
        p->view_count++;
    }
    for (int c = 0; c < p->channel_count; c++) p->channels[c].view = p->view_count ? view_by_name(p, p->channels[c].name) : NULL;
    // The attribute travels with pictures that are no longer stereo.
    if (views_with_channels(p) < 2) forget_views(p);
    return true;
}

void exrio_name_without_view(const exrio_channel *c, char *out, size_t size)
{
    const char *word = c->view ? view_word(c->name, c->view) : NULL;
    if (word)
        snprintf(out, size, "%.*s%s", (int)(word - c->name), c->name, word + strlen(c->view) + 1);
    else
        snprintf(out, size, "%s", c->name);
}

void exrio_name_with_view(const char *name, const char *view, bool is_default, char *out, size_t size)
{
    const char *dot = strrchr(name, '.');
    if (!dot && is_default)
        snprintf(out, size, "%s", name);
    else
        snprintf(out, size, "%.*s%s.%s", dot ? (int)(dot + 1 - name) : 0, name, view, dot ? dot + 1 : name);
}
