#include "pipeline/complete.h"

#include "cli/completion.h"
#include "passes/method.h"
#include "pipeline/layers.h"

enum { MOST = 64 };

// The values of the options whose words this program's tables hold. All zero: no values yet.
typedef struct known_values {
    option_value methods[MOST], bounces[MOST], layers[MOST];
    option_values options[4];
} known_values;

static void fill(known_values *k)
{
    int n = 0;
    for (const method *m = method_next(NULL, SEES_ANY); m && n + 1 < MOST; m = method_next(m, SEES_ANY))
        k->methods[n++] = (option_value){m->name, m->summary};
    n = 0;
    k->bounces[n++].text = "none";
    for (const bounce_kind *const *b = bounces; *b && n + 1 < MOST; b++)
        if ((*b)->source & SEES_PICTURE) k->bounces[n++].text = (*b)->name;
    for (int l = 0; l < LAYER_COUNT && l + 1 < MOST; l++) k->layers[l].text = layer_table[l]->name;
    k->options[0] = (option_values){"method", k->methods, false};
    k->options[1] = (option_values){"bounce", k->bounces, false};
    k->options[2] = (option_values){"layers", k->layers, true};
}

void help_write(FILE *to)
{
    known_values k = {0};
    fill(&k);
    options_print_help(to, k.options);
}

void complete_write(FILE *to, completion_part part)
{
    known_values k = {0};
    fill(&k);
    if (part == COMPLETE_METHODS_MAN)
        methods_print_man(to);
    else if (part == COMPLETE_METHODS_MARKDOWN)
        methods_print_markdown(to);
    else
        completion_print(to, part == COMPLETE_ZSH, k.options);
}
