#include "pipeline/views.h"

#include <string.h>

static bool listed(const char *const *names, int count, const char *view)
{
    for (int i = 0; i < count; i++)
        if (strcmp(names[i], view) == 0) return true;
    return false;
}

int views_of(const exr_file *file, const options *o, const char *names[VIEWS_MAX])
{
    int count = 0;
    for (int i = 0; i < file->part_count && count < VIEWS_MAX; i++)
        if (file->parts[i].view[0] && !listed(names, count, file->parts[i].view)) names[count++] = file->parts[i].view;
    for (int i = 0; o->view_layer && i < count; i++)
        if (strcmp(names[i], o->view_layer) == 0) {
            names[0] = names[i];
            return 1;
        }
    return count > 1 ? count : 0;
}

bool view_has(const exr_part *part, const char *view) { return !view || strcmp(part->view, view) == 0; }
