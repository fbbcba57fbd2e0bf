#include "pipeline/further_views.h"

#include <stdlib.h>

#include "base/mem.h"
#include "pipeline/inputs.h"
#include "pipeline/read.h"

_Static_assert(SHOT_VIEWS + OPT_MOST_PATHS <= MAX_FURTHER, "shaders/include/constants.glsl");

enum { MOST_PIXELS = 1 << 19 }; // of each

static bool are_looked_at(const frame_result *r)
{
    return r->plan.light || r->plan.method == method_default() || r->plan.layers & 1u << LAYER_CONFIDENCE;
}

static bool check_world(const job *j, const frame_result *r, error *e)
{
    if (r->gb.camera.has_world && r->gb.camera.kind == CAMERA_PERSPECTIVE) return true;
    return err_set(
        e, ERR_INPUT, r->file->path, NULL,
        "%s is in world space, and this frame has no perspective camera that is known there; give it with --camera FILE",
        j->o->also.count > 0 ? "--also" : "--surround shot");
}

static bool load_frame(job *j, int frame, error *e)
{
    input_paths *in = mem_zero(1, sizeof *in, e);
    error here = {0};
    bool ok = in && (inputs_of_frame(j->o, frame, in) ||
                     err_set(e, ERR_USAGE, j->o->inputs[0], NULL, "the path of frame %d is too long", frame));
    if (ok && read_shot_view(j, in->list, in->count, MOST_PIXELS, &j->views[j->view_count], &here)) {
        j->view_count++;
    } else if (ok && here.code == ERR_INPUT && !here.refused && j->o->keep_going) {
        char why[ERROR_TEXT];
        err_format(&here, why, sizeof why);
        log_warn(j->log, "surround", "--surround shot does without frame %d: %s", frame, why);
    } else if (ok) {
        *e = here;
        ok = false;
    }
    free(in);
    return ok;
}

static void say(const job *j, const frame_list *frames)
{
    char text[256];
    frames_format(frames, text, sizeof text);
    log_info(j->log, "surround: frames %s of the shot are looked at for what a frame does not show (--surround)", text);
}

bool further_views_load(job *j, const frame_result *r, error *e)
{
    const path_list *also = &j->o->also;
    const frame_list *shot = j->files ? &j->files->shot : &(frame_list){0};
    if (also->count + shot->count == 0 || j->views_loaded || !are_looked_at(r) || r->gb.valid == 0) return true;
    if (!check_world(j, r, e)) return false;
    if (shot->count > 0) say(j, shot);
    for (int i = 0; i < also->count; i++, j->view_count++)
        if (!read_world_view(j, also->path[i], MOST_PIXELS, &j->views[j->view_count], e)) return false;
    for (int i = 0; i < shot->count; i++)
        if (!load_frame(j, shot->frames[i], e)) return false;
    j->views_loaded = true;
    return true;
}
