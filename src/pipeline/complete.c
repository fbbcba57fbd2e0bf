#include "pipeline/complete.h"

#include <string.h>

#include "cli/completion.h"
#include "passes/method.h"
#include "pipeline/layers.h"

static void append(char *list, size_t size, const char *name)
{
    size_t used = strlen(list);
    snprintf(list + used, size - used, "%s%s", used ? " " : "", name);
}

void complete_write(FILE *to, const char *shell)
{
    char method_list[METHOD_NAMES], layer_list[512] = "";
    method_names(method_list, sizeof method_list, " ");
    for (int l = 0; l < LAYER_COUNT; l++) append(layer_list, sizeof layer_list, layer_table[l]->name);
    const completion_values values[] = {{"method", method_list, false}, {"layers", layer_list, true}, {NULL, NULL, false}};
    completion_print(to, shell, values);
}
