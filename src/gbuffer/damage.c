// Warnings about geometry that no longer describes the surface, because it was filtered or compressed as a colour.
#include <openexr_attr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/mem.h"
#include "gbuffer/build.h"

enum { LOOKED_AT_ROWS = 256, LEAST_EDGES = 30, REACHES = 2 }; // a filter is one to four pixels wide
static const double most_between = 0.3; // share of the edges that may have a value in between: thin things do
static const double worst_length = 0.002;

// Edges that a row of pixels crosses, and how many of them have a pixel that is neither side's.
typedef struct edges {
    size_t all, between;
} edges;

static bool filtered(const edges *e) { return e->all >= LEAST_EDGES && (double)e->between > most_between * (double)e->all; }

// Depths of a row, 0 where there is no surface. There is an edge at a pixel if on each side, `reach` away, two pixels agree with
// each other and differ from those of the other side. If the pixel was sampled at a point, it belongs to one of the sides.
static void count_depth(const double *z, int n, int reach, edges *out)
{
    for (int x = reach + 1; x < n - reach - 1; x++) {
        double a = z[x - reach], b = z[x - reach - 1], c = z[x + reach], d = z[x + reach + 1], step = fabs(a - c);
        if (!(a > 0.0 && c > 0.0 && z[x] > 0.0 && b > 0.0 && d > 0.0)) continue;
        if (step < 0.1 * fmin(a, c) || fabs(a - b) > 0.1 * step || fabs(c - d) > 0.1 * step) continue;
        double share = (z[x] - a) / (c - a);
        out->all++;
        out->between += share > 0.1 && share < 0.9;
    }
}

// The mean of two unit normals is shorter than they are.
static void count_normals(const vec3 *n, int count, int reach, edges *out)
{
    for (int x = reach; x < count - reach; x++) {
        if (!(v3_dot(n[x - reach], n[x + reach]) <= 0.8)) continue;
        double a = v3_length(n[x - reach]), b = v3_length(n[x]), c = v3_length(n[x + reach]);
        if (!(fabs(a - 1.0) < 0.01 && fabs(c - 1.0) < 0.01 && b > 0.0)) continue;
        out->all++;
        out->between += b < 0.98;
    }
}

typedef struct look {
    edges position[REACHES], normal[REACHES], depth[REACHES];
    double *z[2];
    vec3 *n;
} look;

static vec3 stored_normal(const build *b, int x, int y)
{
    vec3 n = v3(plane_get(&b->normal.n[0], x, y), plane_get(&b->normal.n[1], x, y), plane_get(&b->normal.n[2], x, y));
    n = encoding_decode(b->normal.encoding, n);
    return v3_finite(n) ? n : v3(0, 0, 0);
}

static void look_at_row(const build *b, int y, look *l)
{
    int w = b->g->width;
    for (int x = 0; x < w; x++) {
        bool there = b->position.raw[build_index(b, x, y)] > 0.0f;
        l->z[0][x] = there && b->position.has_p ? camera_from_world(&b->g->camera, build_position(b, x, y)).z : 0.0;
        l->z[1][x] = there && b->position.has_z && b->position.z_measured ? build_depth(b, x, y) : 0.0;
        l->n[x] = there && b->normal.there ? stored_normal(b, x, y) : v3(0, 0, 0);
    }
    for (int r = 0; r < REACHES; r++) {
        count_depth(l->z[0], w, r + 1, &l->position[r]);
        count_depth(l->z[1], w, r + 1, &l->depth[r]);
        count_normals(l->n, w, r + 1, &l->normal[r]);
    }
}

// "arnold/aovs/P/filter" when it is no closest filter, else "".
static const char *header_filter(const build *b, role r)
{
    channel_ref ref = b->r->channels[r][0];
    if (b->r->components[r] == 0 || !b->file->core) return "";
    const char *channel = b->file->parts[ref.part].channels[ref.channel].name, *value;
    char name[300];
    snprintf(name, sizeof name, "arnold/aovs/%.*s/filter", (int)strcspn(channel, "."), channel);
    return exrio_attr_string(b->file, ref.part, name, &value) && !strstr(value, "closest") ? value : "";
}

static void warn_filtered(build *b, role r, const edges of_reach[REACHES])
{
    const edges *e = filtered(&of_reach[0]) ? &of_reach[0] : &of_reach[1];
    const char *header = header_filter(b, r);
    bool seen = filtered(e);
    if (!seen && !header[0]) return;
    if (seen) b->filtered |= 1u << r;
    char key[32], evidence[128] = "";
    snprintf(key, sizeof key, "filtered-%s", role_name(r));
    if (seen)
        snprintf(evidence, sizeof evidence, "%.0f %% of the edges have a value in between",
                 100.0 * (double)e->between / (double)e->all);
    log_warn(b->log, key,
             "the %s pass is anti-aliased (%s%s%s): edges hold surfaces that are not there; render it with a closest filter",
             role_name(r), evidence,
             seen && header[0] ? "; the header says "
             : header[0]       ? "the header says "
                               : "",
             header);
}

// DWA stores channels of these names as colours, with loss, and all others as they are.
static bool lossy_name(const char *channel)
{
    static const char *const names[] = {"r", "g", "b", "y", "by", "ry", "red", "green", "blue"};
    const char *dot = strrchr(channel, '.'), *last = dot ? dot + 1 : channel;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcasecmp(last, names[i]) == 0) return true;
    return false;
}

// Share of the sampled pixels whose normal is no unit vector, or whose position is not on its pixel.
static double damaged_share(const build *b, role r)
{
    size_t bad = 0;
    for (size_t i = 0; i < b->sample.count; i++) {
        const camera_point *p = &b->sample.points[i];
        double x, y;
        if (r == ROLE_NORMAL)
            bad += fabs(v3_length(stored_normal(b, (int)p->x, (int)p->y)) - 1.0) > worst_length;
        else
            bad += !camera_project(&b->g->camera, camera_from_world(&b->g->camera, p->world), &x, &y) ||
                   hypot(x - p->x, y - p->y) > 0.1;
    }
    return b->sample.count ? (double)bad / (double)b->sample.count : 0.0;
}

// What a lossy compression does to data, and which channels it does it to.
typedef struct loss {
    exr_compression_t first, last;
    bool (*takes)(const exrio_channel *c);
    const char *name, *how; // of the pass's name: "took the %s pass ..."
    bool measured;          // worth a word only where the pixels show it
} loss;

static bool loses_colours(const exrio_channel *c) { return lossy_name(c->name); }
static bool loses_halves(const exrio_channel *c) { return c->type == SAMPLE_HALF; }
static bool loses_floats(const exrio_channel *c) { return c->type == SAMPLE_FLOAT; }

static const loss losses[] = {
    {EXR_COMPRESSION_DWAA, EXR_COMPRESSION_DWAB, loses_colours, "DWA", "took the %s pass for a colour and stored it with loss",
     false},
    {EXR_COMPRESSION_B44, EXR_COMPRESSION_B44A, loses_halves, "B44", "stored the half floats of the %s pass with loss", false},
    {EXR_COMPRESSION_PXR24, EXR_COMPRESSION_PXR24, loses_floats, "PXR24", "cut the floats of the %s pass to 24 bits", true},
};

static const loss *loss_of(const exrio_part *part, const exrio_channel *c)
{
    for (size_t i = 0; i < sizeof losses / sizeof *losses; i++)
        if (part->compression >= (int)losses[i].first && part->compression <= (int)losses[i].last && losses[i].takes(c))
            return &losses[i];
    return NULL;
}

static void warn_loss(build *b, role r)
{
    const double worth_a_word = 0.01;
    char list[300] = "", key[32], how[128], measured[64] = "";
    const loss *found = NULL;
    size_t used = 0;
    for (int k = 0; k < b->r->components[r]; k++) {
        channel_ref ref = b->r->channels[r][k];
        const exrio_channel *c = &b->file->parts[ref.part].channels[ref.channel];
        const loss *l = loss_of(&b->file->parts[ref.part], c);
        if (l) found = l;
        if (l && used + strlen(c->name) + 3 < sizeof list)
            used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", used ? ", " : "", c->name);
    }
    if (!found) return;
    bool can_measure = r != ROLE_DEPTH && (r != ROLE_POSITION || b->camera.has_pose);
    double share = can_measure ? damaged_share(b, r) : 0.0;
    if (found->measured && share < worth_a_word) return;
    if (can_measure) snprintf(measured, sizeof measured, "; %.0f %% of the pixels show it", 100.0 * share);
    snprintf(key, sizeof key, "%s-%s", found->name, role_name(r));
    snprintf(how, sizeof how, found->how, role_name(r));
    log_warn(b->log, key, "%s: %s compression %s%s; use ZIP or PIZ for data", list, found->name, how, measured);
}

bool damage_warn(build *b)
{
    size_t w = (size_t)b->g->width;
    look l = {.z = {mem_pixels(w, sizeof(double), b->e), mem_pixels(w, sizeof(double), b->e)},
              .n = mem_pixels(w, sizeof(vec3), b->e)};
    bool ok = l.z[0] && l.z[1] && l.n;
    int stride = b->g->height / LOOKED_AT_ROWS + 1;
    for (int y = 0; ok && y < b->g->height; y += stride) look_at_row(b, y, &l);
    if (ok) {
        warn_filtered(b, ROLE_POSITION, l.position);
        warn_filtered(b, ROLE_DEPTH, l.depth);
        if (!b->row->normals_averaged) warn_filtered(b, ROLE_NORMAL, l.normal);
        for (int r = ROLE_POSITION; r <= ROLE_DEPTH; r++) warn_loss(b, (role)r);
    }
    free(l.z[0]);
    free(l.z[1]);
    free(l.n);
    return ok;
}
