#include "pipeline/views.h"

#include <stdio.h>
#include <string.h>

static bool listed(const char *const *names, int count, const char *view)
{
    for (int i = 0; i < count; i++)
        if (strcmp(names[i], view) == 0) return true;
    return false;
}

static int all_views(const exrio_file *file, const char *names[VIEWS_MAX])
{
    int count = 0;
    for (int i = 0; i < file->part_count; i++) {
        const exrio_part *p = &file->parts[i];
        if (p->deep) continue;
        const char *const own[1] = {p->view}, *const *views = p->view[0] ? own : (const char *const *)p->views;
        for (int v = 0; v < (p->view[0] ? 1 : p->view_count) && count < VIEWS_MAX; v++)
            if (!listed(names, count, views[v])) names[count++] = views[v];
    }
    return count;
}

// Whether the name is the view's, or a view layer's with the view's behind it; *before receives that view layer's length.
static bool ends_in_view(const char *name, const char *view, size_t *before)
{
    size_t n = strlen(name), v = strlen(view);
    if (n < v || strcmp(name + n - v, view) != 0 || (n > v && name[n - v - 1] != '.')) return false;
    *before = n > v ? n - v - 1 : 0;
    return true;
}

int views_of(const exrio_file *file, const options *o, const char *names[VIEWS_MAX])
{
    int count = all_views(file, names);
    size_t before;
    for (int i = 0; o->view_layer && i < count; i++)
        if (ends_in_view(o->view_layer, names[i], &before)) {
            names[0] = names[i];
            return 1;
        }
    return count > 1 ? count : 0;
}

const char *view_layer_within(const options *o, const char *view, char *buf, size_t size)
{
    size_t before;
    if (!view || !o->view_layer || !ends_in_view(o->view_layer, view, &before)) return o->view_layer;
    snprintf(buf, size, "%.*s", (int)before, o->view_layer);
    return before ? buf : NULL;
}

bool view_has(const exrio_part *part, const char *view)
{
    return !view || strcmp(part->view, view) == 0 || listed((const char *const *)part->views, part->view_count, view);
}

bool view_in_names(const exrio_file *file, const char *view)
{
    for (int i = 0; view && i < file->part_count; i++)
        if (listed((const char *const *)file->parts[i].views, file->parts[i].view_count, view)) return true;
    return false;
}

// The default view is the first of the first part that has any.
static bool is_default(const exrio_file *file, const char *view)
{
    for (int i = 0; i < file->part_count; i++)
        if (file->parts[i].view_count) return strcmp(file->parts[i].views[0], view) == 0;
    return false;
}

void view_name(const exrio_file *file, const char *view, const char *name, char *out, size_t size)
{
    if (view_in_names(file, view))
        exrio_name_with_view(name, view, is_default(file, view), out, size);
    else
        snprintf(out, size, "%s", name);
}
