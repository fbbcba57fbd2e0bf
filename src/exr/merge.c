// Several files of one frame as one: exrio_file_open_all.
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/mem.h"
#include "cli/names.h"
#include "exr/internal.h"

enum { STEM = 256 };

static bool is_separator(char c) { return c == '.' || c == '_' || c == '-' || c == ' '; }

// The file's name without folder, ending and frame number.
static void stem_of(const char *path, char *out)
{
    const char *slash = strrchr(path, '/');
    snprintf(out, STEM, "%s", slash ? slash + 1 : path);
    size_t n = strlen(out);
    if (n > 4 && strcasecmp(out + n - 4, ".exr") == 0) out[n -= 4] = 0;
    size_t digits = n;
    while (digits > 0 && isdigit((unsigned char)out[digits - 1])) digits--;
    if (digits < n && (digits == 0 || is_separator(out[digits - 1]))) out[digits > 0 ? digits - 1 : 0] = 0;
}

// Length of what all stems begin with, cut back to the end of a word.
static size_t common_beginning(char (*stems)[STEM], int count)
{
    size_t n = strlen(stems[0]);
    for (int i = 1; i < count; i++) {
        size_t k = 0;
        while (k < n && stems[i][k] == stems[0][k]) k++;
        n = k;
    }
    for (; n > 0; n--) {
        bool word = true;
        for (int i = 0; i < count; i++)
            word = word && (is_separator(stems[i][n - 1]) || is_separator(stems[i][n]) || !stems[i][n]);
        if (word) break;
    }
    return n;
}

// What tells the file from the others: "shot_P.0001.exr" among "shot_N.0001.exr" and so on is P.
static void pass_name(const char *stem, size_t common, char *out)
{
    const char *p = stem + common;
    while (is_separator(*p)) p++;
    size_t n = 0;
    for (; *p && n < STEM - 1; p++) out[n++] = isalnum((unsigned char)*p) || *p == '_' || *p == ' ' ? *p : '_';
    out[n] = 0;
}

// The picture itself keeps its plain R G B A.
static bool is_picture(const char *name)
{
    // color, colour, noisy, hdr: as denoisers and their training sets call the picture that is still to be denoised.
    static const char *const names[] = {"",  "beauty", "rgba",   "rgb",   "combined", "image",  "main", "ci",
                                        "c", "color",  "colour", "noisy", "hdr",      "render", "final"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcasecmp(name, names[i]) == 0) return true;
    return false;
}

// Channels without a layer get the pass for one. *renamed: there were some.
static bool name_channels(exrio_part *part, const char *pass, bool *renamed, error *e)
{
    *renamed = false;
    for (int c = 0; c < part->channel_count; c++) {
        exrio_channel *channel = &part->channels[c];
        char name[STEM * 2];
        char plain[STEM], with_pass[STEM * 2];
        exrio_name_without_view(channel, plain, sizeof plain);
        if (strchr(plain, '.')) continue;
        snprintf(with_pass, sizeof with_pass, "%s.%s", pass, plain);
        if (channel->view)
            exrio_name_with_view(with_pass, channel->view, false, name, sizeof name);
        else
            snprintf(name, sizeof name, "%s", with_pass);
        char *copy = mem_string(name, e);
        if (!copy) return false;
        channel->stored = channel->name;
        channel->name = copy;
        *renamed = true;
    }
    return true;
}

static bool take_member(exrio_file *all, exrio_file *member, const char *pass, error *e)
{
    bool renamed = false;
    if (member->part_count == 1 && !member->parts[0].name[0] && !is_picture(pass) &&
        !name_channels(&member->parts[0], pass, &renamed, e))
        return false;
    for (int p = 0; p < member->part_count; p++) {
        exrio_part *part = &all->parts[all->part_count];
        *part = member->parts[p];
        part->name = mem_string(renamed ? pass : part->name, e);
        if (!part->name) return false;
        all->part_count++;
    }
    return true;
}

static const char *file_of(const exrio_file *all, int part) { return exrio_part_file(all, &part)->path; }

static bool same_frame(const exrio_file *all, error *e)
{
    for (int i = 1; i < all->part_count; i++) {
        const exrio_part *a = &all->parts[0], *b = &all->parts[i];
        if (box2_equal(a->display_window, b->display_window) && a->pixel_aspect == b->pixel_aspect) continue;
        return err_set(e, ERR_INPUT, file_of(all, i), NULL,
                       "has a display window of %d x %d pixels, %s one of %d x %d; inputs of one frame must have the same",
                       box2_width(b->display_window), box2_height(b->display_window), file_of(all, 0),
                       box2_width(a->display_window), box2_height(a->display_window));
    }
    return true;
}

static bool fail_duplicate(const exrio_file *all, int part, int channel, int other, error *e)
{
    char pattern[512];
    const char *path = file_of(all, part), *before = file_of(all, other);
    if (names_are_frames(before, path, pattern, sizeof pattern))
        return err_set(e, ERR_USAGE, path, NULL, NAMES_SEQUENCE, pattern);
    return err_set(e, ERR_INPUT, path, all->parts[part].channels[channel].name, "this channel is in %s too; give each pass once",
                   before);
}

// Within one file parts may share channel names, and often do.
static bool no_duplicates(const exrio_file *all, error *e)
{
    for (int i = 1; i < all->part_count; i++)
        for (int k = 0; k < i; k++) {
            if (file_of(all, i) == file_of(all, k)) continue;
            for (int a = 0; a < all->parts[i].channel_count; a++)
                for (int b = 0; b < all->parts[k].channel_count; b++)
                    if (strcmp(all->parts[i].channels[a].name, all->parts[k].channels[b].name) == 0)
                        return fail_duplicate(all, i, a, k, e);
        }
    return true;
}

static bool take_all(exrio_file *all, char (*stems)[STEM], error *e)
{
    int parts = 0, count = all->member_count;
    for (int i = 0; i < count; i++) parts += all->members[i]->part_count;
    all->parts = mem_zero((size_t)parts, sizeof *all->parts, e);
    all->path = mem_string(all->members[0]->path, e);
    if (!all->parts || !all->path) return false;
    all->core = all->members[0]->core;
    size_t common = common_beginning(stems, count);
    for (int i = 0; i < count; i++) {
        char pass[STEM];
        pass_name(stems[i], common, pass);
        if (!take_member(all, all->members[i], pass, e)) return false;
    }
    return same_frame(all, e) && no_duplicates(all, e);
}

bool exrio_file_open_all(const char *const *paths, int count, exrio_file **out, error *e)
{
    *out = NULL;
    if (count == 1) return exrio_file_open(paths[0], out, e);
    exrio_file *all = mem_zero(1, sizeof *all, e);
    char(*stems)[STEM] = mem_zero((size_t)count, sizeof *stems, e);
    exrio_file **members = mem_zero((size_t)count, sizeof *members, e);
    if (!all || !stems || !members) {
        free(all);
        free(stems);
        free(members);
        return false;
    }
    bool ok = true;
    all->members = members;
    for (int i = 0; ok && i < count; i++) {
        stem_of(paths[i], stems[i]);
        ok = exrio_file_open(paths[i], &members[i], e);
        all->member_count += ok;
    }
    ok = ok && take_all(all, stems, e);
    free(stems);
    if (ok)
        *out = all;
    else
        exrio_file_close(all);
    return ok;
}

const exrio_file *exrio_part_file(const exrio_file *file, int *part)
{
    for (int i = 0; i < file->member_count; i++) {
        if (*part < file->members[i]->part_count) return file->members[i];
        *part -= file->members[i]->part_count;
    }
    return file;
}

void exrio_merged_close(exrio_file *file)
{
    for (int i = 0; file->parts && i < file->part_count; i++) free(file->parts[i].name); // the rest is the members'
    for (int i = 0; i < file->member_count; i++) exrio_file_close(file->members[i]);
    free(file->members);
    free(file->parts);
    free(file->path);
    free(file);
}
