#include "pipeline/inputs.h"

#include <stdio.h>
#include <string.h>

#include "cli/frames.h"

bool inputs_are_framed(const options *o) { return o->frames || (o->input_count > 0 && !o->literal && pattern_is(o->inputs[0])); }

bool inputs_of_frame(const options *o, int frame, input_paths *out)
{
    out->count = o->input_count;
    for (int i = 0; i < o->input_count; i++) {
        bool fits = strlen(o->inputs[i]) < INPUT_PATH;
        if (!o->literal && pattern_is(o->inputs[i]))
            fits = pattern_path(o->inputs[i], frame, out->text[i], INPUT_PATH);
        else if (fits)
            snprintf(out->text[i], INPUT_PATH, "%s", o->inputs[i]);
        if (!fits) return false;
        out->list[i] = out->text[i];
    }
    return true;
}
