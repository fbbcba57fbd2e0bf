#include "pipeline/prepare.h"

#include "cli/frames.h"
#include "pipeline/filter.h"
#include "pipeline/settings.h"

// What the rooms below have not said themselves: channels, camera and measurements are theirs.
static void describe(const job *j, const frame_result *r, shot_facts shot)
{
    log_info(j->log, "surfaces: %zu of %zu pixels", r->gb.valid, (size_t)r->gb.width * (size_t)r->gb.height);
    log_info(j->log, "radius: %g scene units%s; thickness %g", r->set.radius, j->o->radius_unit == RADIUS_AUTO ? " (auto)" : "",
             r->set.thickness);
    if (shot.roof >= 0.0)
        log_info(j->log, "outside: %g of the unseen directions are open, as %.3g %% of the picture is a roof (--outside)",
                 openness_mean(&shot.outside), 100.0 * shot.roof);
    else if (plan_asks_outside(j->o) && r->plan.light)
        log_info(j->log, "outside: open, as nobody knows which way is up (--outside)");
}

bool frame_check_world(const job *j, const frame_result *r, error *e)
{
    bool camera_frame = j->o->env_frame == FRAME_CAMERA;
    if (!(j->o->env || r->plan.need_to_fit) || !r->plan.light || camera_frame || r->gb.camera.has_rotation || r->gb.valid == 0)
        return true;
    return err_set(e, ERR_INPUT, r->file->path, NULL,
                   "--env needs world directions, and this frame's camera rotation is unknown; use --env-frame camera, --camera "
                   "FILE or, if the normals are in world space, --normal-space world");
}

// The frame's own spheres. Only a world camera can place them.
static bool load_proxies(const job *j, frame_result *r, error *e)
{
    char path[4096];
    if (!j->o->proxies) return true;
    if (!r->gb.camera.has_world && r->gb.valid > 0)
        return err_set(e, ERR_INPUT, r->file->path, NULL,
                       "--proxies are in world space, and this frame's camera is not known there; give it with --camera FILE");
    bool many = false;
    if (!proxies_are_framed(j->o, &many, e)) return false;
    if (many && !pattern_path(j->o->proxies, r->frame, path, sizeof path))
        return err_set(e, ERR_USAGE, j->o->proxies, NULL, "--proxies: frame %d has no file name by this pattern", r->frame);
    return proxies_load(many ? path : j->o->proxies, &r->proxies, e);
}

static bool prepare_view(const job *j, frame_result *r, shot_facts shot, error *e)
{
    if (r->gb.valid == 0) log_warn(j->log, "empty", "%s: no pixel has a surface; the layers are neutral", r->file->path);
    r->set = settings_of(j, r, shot);
    describe(j, r, shot);
    return frame_check_scale(r, e) && frame_check_world(j, r, e) && load_proxies(j, r, e) && filter_prepare(j, r, e);
}

bool frame_prepare(const job *j, frame_result *r, error *e)
{
    if (r->prepared) return true;
    stopwatch t = stopwatch_start();
    shot_facts shot = settings_shot(j, r);
    bool ok = true;
    for (frame_result *v = r; ok && v; v = v->next_view) {
        v->frame = r->frame;
        ok = prepare_view(j, v, shot, e);
    }
    result_lap(r, STAGE_RESOLVE, &t);
    return ok;
}
