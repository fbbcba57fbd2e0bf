#include "pipeline/layers.h"

#include <stdio.h>
#include <string.h>

static bool unknown(const char *name, size_t n, error *e)
{
    char known[160] = "";
    for (int i = 0; i < LAYER_COUNT; i++)
        snprintf(known + strlen(known), sizeof known - strlen(known), "%s%s", i ? ", " : "", layer_table[i]->name);
    return err_set(e, ERR_USAGE, NULL, NULL, "--layers: there is no layer '%.*s'; the layers are %s", (int)n, name, known);
}

bool layers_parse(const char *list, unsigned *set, error *e)
{
    *set = 0;
    for (int i = 0; !list && i < LAYER_COUNT; i++)
        if (layer_table[i]->by_default) *set |= 1u << i;
    while (list && *list) {
        size_t n = strcspn(list, ",");
        int found = -1;
        for (int i = 0; i < LAYER_COUNT; i++)
            if (strlen(layer_table[i]->name) == n && strncmp(layer_table[i]->name, list, n) == 0) found = i;
        if (found < 0) return unknown(list, n, e);
        *set |= 1u << found;
        list += n + (list[n] == ',');
    }
    return *set != 0 || unknown("", 0, e);
}
