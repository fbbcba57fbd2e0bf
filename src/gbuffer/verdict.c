#include "gbuffer/verdict.h"

#include <stdio.h>
#include <string.h>

void verdict_try(verdict *v, const char *name, double fit, double loss)
{
    for (int i = 0; i < v->count; i++)
        if (strcmp(v->tried[i].name, name) == 0) return;
    if (v->count == VERDICT_HYPOTHESES && v->tried[v->count - 1].loss <= loss) return;
    int at = v->count < VERDICT_HYPOTHESES ? v->count++ : VERDICT_HYPOTHESES - 1;
    for (; at > 0 && !(v->tried[at - 1].loss <= loss); at--) v->tried[at] = v->tried[at - 1];
    v->tried[at] = (hypothesis){.fit = fit, .loss = loss};
    snprintf(v->tried[at].name, sizeof v->tried[at].name, "%s", name);
}
