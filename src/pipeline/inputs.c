#include "pipeline/inputs.h"

#include <stdio.h>
#include <string.h>

#include "base/mem.h"

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

bool shot_frames(const options *o, frame_list *out, error *e)
{
    frame_list all = {0};
    *out = (frame_list){0};
    if (!inputs_are_framed(o) || o->input_count == 0 || !pattern_is(o->inputs[0]))
        return err_set(
            e, ERR_USAGE, o->input_count > 0 ? o->inputs[0] : NULL, NULL,
            "--surround shot takes frames of a sequence, and this input has no place for the frame: ####, %%04d or $F4");
    if (!pattern_scan(o->inputs[0], &all, e)) return false;
    out->count = all.count < SHOT_VIEWS ? all.count : SHOT_VIEWS;
    out->frames = mem_zero(SHOT_VIEWS, sizeof *out->frames, e);
    for (int i = 0; out->frames && i < out->count; i++)
        out->frames[i] = all.frames[out->count < 2 ? 0 : (2 * i * (all.count - 1) + out->count - 1) / (2 * (out->count - 1))];
    frames_free(&all);
    return out->frames != NULL;
}
