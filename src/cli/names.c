#include "cli/names.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "base/infile.h"
#include "cli/frames.h"

static bool digits(const char *from, const char *to)
{
    for (const char *p = from; p < to; p++)
        if (!isdigit((unsigned char)*p)) return false;
    return to > from;
}

bool names_are_frames(const char *a, const char *b, char *pattern, size_t size)
{
    const char *end_a = a + strlen(a), *end_b = b + strlen(b), *p = a, *q = b;
    while (*p && *p == *q) p++, q++;
    while (p > a && isdigit((unsigned char)p[-1])) p--, q--;
    while (end_a > p && end_b > q && end_a[-1] == end_b[-1]) end_a--, end_b--;
    while (isdigit((unsigned char)*end_a) && isdigit((unsigned char)*end_b)) end_a++, end_b++;
    if (!digits(p, end_a) || !digits(q, end_b) || strchr(end_a, '/')) return false;
    // Numbers of one length are padded; others are as long as they are.
    int width = end_a - p == end_b - q ? (int)(end_a - p) : 1;
    snprintf(pattern, size, "%.*s%.*s%s", (int)(p - a), a, width < 20 ? width : 20, "####################", end_a);
    return true;
}

static bool any_fits(const char *pattern, bool *any, error *e)
{
    frame_list found;
    if (!pattern_scan(pattern, &found, e)) return false;
    *any = found.count > 0;
    frames_free(&found);
    return true;
}

bool names_are_literal(const options *o, bool *literal, error *e)
{
    bool there = false, any = true;
    *literal = false;
    if (o->frames || o->input_count == 0 || !pattern_is(o->inputs[0])) return true;
    if (!infile_exists(o->inputs[0], (infile_kind){NULL, ERR_INPUT}, &there, e)) return false;
    *literal = there && o->output && !pattern_is(o->output);
    if (!there || *literal) return true;
    if (!any_fits(o->inputs[0], &any, e)) return false;
    *literal = !any;
    return true;
}

static const char *ending_of(const char *path)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    return dot ? dot + 1 : "";
}

static bool is_one_of(const char *text, const char *const *list, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (strcasecmp(text, list[i]) == 0) return true;
    return false;
}

bool names_check_output(const char *output, error *e)
{
    static const char *const others[] = {"png", "jpg", "jpeg", "tif", "tiff", "tga",  "bmp", "gif", "hdr", "dpx", "cin",
                                         "pfm", "ppm", "webp", "psd", "jp2",  "avif", "iff", "rgb", "tx",  "sgi"};
    if (!is_one_of(ending_of(output), others, sizeof others / sizeof *others)) return true;
    return err_set(e, ERR_USAGE, output, NULL,
                   "the output is an OpenEXR file and this names another format; call it .exr (--preview FILE.png also makes a "
                   "picture for the eye)");
}

void names_warn(const options *o, log_t *log)
{
    static const char *const ours[] = {"exr", "sxr", "mxr"}; // stereo and multi-view files are called so too
    bool literal = o->literal || o->input_count == 0 || !pattern_is(o->inputs[0]);
    if (!is_one_of(ending_of(o->output), ours, sizeof ours / sizeof *ours))
        log_warn(log, "ending", "%s: the output is an OpenEXR file, and its name does not end in .exr", o->output);
    if (literal && !o->frames && !o->literal && pattern_is(o->output))
        log_warn(log, "place",
                 "%s: the output has a place for a frame and the input has none, so the file is called exactly that; for a "
                 "sequence give the input a place too",
                 o->output);
    if (!literal && access(o->inputs[0], F_OK) == 0)
        log_warn(log, "pattern", "%s: there is a file of exactly this name, which is left alone: # stands for the frame",
                 o->inputs[0]);
}
