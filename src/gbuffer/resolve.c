#include "gbuffer/resolve.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "gbuffer/conventions.h"
#include "gbuffer/guess.h"
#include "gbuffer/layers.h"
#include "gbuffer/named.h"
#include "gbuffer/picture.h"

enum { MOST_GROUPS = 64 };

static const struct {
    const char *name, *flag;
    layer_kind kind;
} roles[ROLE_COUNT] = {
    [ROLE_POSITION] = {"position", "--position", LAYER_VECTOR},
    [ROLE_NORMAL] = {"normal", "--normal", LAYER_VECTOR},
    [ROLE_DEPTH] = {"depth", "--depth", LAYER_SCALAR},
    [ROLE_ALBEDO] = {"albedo", "--albedo", LAYER_COLOUR},
    [ROLE_BEAUTY] = {"beauty", "--beauty", LAYER_COLOUR},
    [ROLE_ALPHA] = {"alpha", "--beauty", LAYER_SCALAR},
    [ROLE_ROUGHNESS] = {"roughness", "--roughness", LAYER_SCALAR},
    [ROLE_METALLIC] = {"metallic", "--metallic", LAYER_SCALAR},
    [ROLE_EMISSION] = {"emission", "--emission", LAYER_COLOUR},
    [ROLE_DIFFUSE_DIRECT] = {"diffuse direct", "--beauty", LAYER_COLOUR},
    [ROLE_DIFFUSE_INDIRECT] = {"diffuse indirect", "--beauty", LAYER_COLOUR},
};

typedef struct search {
    const exrio_file *file;
    const resolve_options *options;
    layer_index index;
    const convention *row, *plain;
    char keys[MOST_GROUPS][LAYER_KEY]; // the view layers: what stands before a position (or, without any, a depth)
    int key_count;
    const char *key;
    log_t *log;
    error *e;
} search;

const char *role_name(role r) { return roles[r].name; }

static int match(const search *s, const char *pattern, role r, layer_group *groups)
{
    return layers_match(&s->index, pattern, roles[r].kind, groups, MOST_GROUPS);
}

// 4 for a role some pattern finds, 5 if it does so in the same case.
static int role_score(const search *s, const convention *row, role r)
{
    layer_group groups[MOST_GROUPS];
    int best = 0;
    for (int p = 0; p < CONVENTION_PATTERNS && row->patterns[r][p]; p++)
        for (int n = match(s, row->patterns[r][p], r, groups); n > 0; n--) {
            int points = groups[n - 1].exact ? 5 : 4;
            best = points > best ? points : best;
        }
    return best;
}

// "name", "beginning*" or "name=beginning of its text" (conventions.h).
static bool mark_stands(const exrio_file *file, int part, const char *mark)
{
    size_t n = strlen(mark);
    const char *equals = strchr(mark, '='), *text;
    char name[64];
    if (n > 0 && mark[n - 1] == '*') return exrio_attr_begins(file, part, mark, n - 1);
    if (!equals) return exrio_attr_exists(file, part, mark);
    snprintf(name, sizeof name, "%.*s", (int)(equals - mark), mark);
    return exrio_attr_string(file, part, name, &text) && strncasecmp(text, equals + 1, strlen(equals + 1)) == 0;
}

// The mark that the header shows, or NULL.
static const char *find_mark(const exrio_file *file, const convention *row)
{
    for (int m = 0; file->core && m < CONVENTION_MARKS && row->marks[m]; m++)
        for (int p = 0; p < file->part_count; p++)
            if (mark_stands(file, p, row->marks[m])) return row->marks[m];
    return NULL;
}

// The geometry has to be under the row's own names; for the rest the plain row's stand in.
static int row_score(const search *s, const convention *row)
{
    int score = 0, geometry = 0;
    for (int r = 0; r < ROLE_COUNT; r++) {
        bool shape = r == ROLE_POSITION || r == ROLE_NORMAL || r == ROLE_DEPTH;
        int own = role_score(s, row, (role)r), common = shape ? 0 : role_score(s, s->plain, (role)r);
        score += own > common ? own : common;
        geometry += shape ? own : 0;
    }
    return geometry > 0 && find_mark(s->file, row) ? score + 1000 : score;
}

static void choose_row(search *s)
{
    s->row = s->plain = &conventions[convention_count - 1];
    int best = -1;
    for (int i = convention_count - 1; i >= 0; i--) {
        int score = row_score(s, &conventions[i]);
        bool earlier_wins = s->row != s->plain && score == best;
        if (score > best || earlier_wins) best = score, s->row = &conventions[i];
    }
}

static bool known_key(const search *s, const char *key)
{
    for (int k = 0; k < s->key_count; k++)
        if (strcmp(s->keys[k], key) == 0) return true;
    return false;
}

static void gather_keys(search *s, role r)
{
    const convention *rows[2] = {s->row, s->plain};
    layer_group groups[MOST_GROUPS];
    for (int i = 0; i < (s->row == s->plain ? 1 : 2); i++)
        for (int p = 0; p < CONVENTION_PATTERNS && rows[i]->patterns[r][p]; p++) {
            int n = match(s, rows[i]->patterns[r][p], r, groups);
            for (int g = 0; g < n && s->key_count < MOST_GROUPS; g++)
                if (!known_key(s, groups[g].key)) memcpy(s->keys[s->key_count++], groups[g].key, LAYER_KEY);
        }
}

static bool wrong_key(const search *s, const char *what)
{
    char list[400] = "";
    size_t used = 0;
    for (int k = 0; k < s->key_count && used + LAYER_KEY + 8 < sizeof list; k++)
        used += (size_t)snprintf(list + used, sizeof list - used, "%s'%s'", used ? ", " : "", s->keys[k]);
    return err_set(s->e, ERR_INPUT, s->file->path, NULL, "%s; choose one of %s with --view-layer", what, list);
}

// An override of the geometry decides the view layer too, when its name begins with one.
static const char *key_of_override(const search *s)
{
    const char *name = s->options->names[ROLE_POSITION] ? s->options->names[ROLE_POSITION] : s->options->names[ROLE_DEPTH];
    const char *best = NULL;
    for (int k = 0; name && k < s->key_count; k++) {
        size_t n = strlen(s->keys[k]);
        bool begins = n == 0 || (strncasecmp(name, s->keys[k], n) == 0 && name[n] == '.');
        if (begins && (!best || n > strlen(best))) best = s->keys[k];
    }
    return best;
}

// Of several parts that each hold a picture with its depth the first is the file's own, which is worth a word.
static const char *first_picture(const search *s)
{
    for (int k = 0; k < s->key_count; k++) {
        bool picture = false;
        for (int i = 0; i < s->index.count; i++)
            picture |= s->index.entries[i].picture == PICTURE_OF_SEVERAL && strcmp(s->index.entries[i].layer, s->keys[k]) == 0;
        if (!picture) return NULL;
    }
    log_warn(s->log, "pictures",
             "%s: several parts hold a picture and its depth; '%s' is taken, the first (--view-layer names another)",
             s->file->path, s->keys[0]);
    return s->keys[0];
}

static bool choose_key(search *s)
{
    gather_keys(s, ROLE_POSITION);
    if (s->key_count == 0) gather_keys(s, ROLE_DEPTH);
    const char *wanted = s->options->view_layer;
    if (wanted) {
        for (int any_case = 0; any_case < 2; any_case++)
            for (int k = 0; k < s->key_count; k++)
                if ((any_case ? strcasecmp : strcmp)(s->keys[k], wanted) == 0) {
                    s->key = s->keys[k];
                    return true;
                }
        char what[256];
        snprintf(what, sizeof what, "the file has no view layer '%.128s' with positions or depth", wanted);
        if (s->key_count == 0) return err_set(s->e, ERR_INPUT, s->file->path, NULL, "%s", what);
        return wrong_key(s, what);
    }
    if (s->key_count <= 1) {
        s->key = s->key_count ? s->keys[0] : "";
        return true;
    }
    s->key = key_of_override(s);
    if (!s->key) s->key = first_picture(s);
    return s->key || wrong_key(s, "the file holds several view layers");
}

// A channel serves one role, unless the command line says otherwise.
static bool is_taken(const resolution *r, const layer_group *group)
{
    for (int i = 0; i < ROLE_COUNT; i++)
        for (int c = 0; c < r->components[i]; c++)
            for (int k = 0; k < group->components; k++)
                if (r->channels[i][c].part == group->channels[k].part && r->channels[i][c].channel == group->channels[k].channel)
                    return true;
    return false;
}

// The group of the key among those a pattern finds. key NULL: the only group there is, if it is of no other view layer.
static bool pick(const search *s, const char *pattern, role r, const char *key, const resolution *so_far, layer_group *out)
{
    layer_group groups[MOST_GROUPS];
    int n = match(s, pattern, r, groups);
    for (int g = 0; g < n; g++)
        if ((key ? strcmp(groups[g].key, key) == 0 : n == 1 && !known_key(s, groups[g].key)) && !is_taken(so_far, &groups[g])) {
            *out = groups[g];
            return true;
        }
    return false;
}

static bool detect_in(const search *s, const convention *in, const char *key, role r, const resolution *so_far, layer_group *out,
                      const convention **row, const char **pattern)
{
    for (int p = 0; p < CONVENTION_PATTERNS && in->patterns[r][p]; p++)
        if (pick(s, in->patterns[r][p], r, key, so_far, out)) {
            *row = in, *pattern = in->patterns[r][p];
            return true;
        }
    return false;
}

// *row and *pattern receive what found it. Positions and normals are looked for under every renderer's names in the end: whose
// they are is seen from the pixels.
static bool detect(const search *s, role r, const resolution *so_far, layer_group *out, const convention **row,
                   const char **pattern)
{
    const char *const scopes[3] = {s->key, "", NULL};
    const convention *rows[2] = {s->row, s->plain};
    for (int scope = 0; scope < 3; scope++)
        for (int i = 0; i < 2; i++)
            if (detect_in(s, rows[i], scopes[scope], r, so_far, out, row, pattern)) return true;
    for (int i = 0; (r == ROLE_POSITION || r == ROLE_NORMAL) && i < convention_count; i++)
        if (detect_in(s, &conventions[i], s->key, r, so_far, out, row, pattern)) return true;
    return false;
}

static void take(resolution *out, role r, const layer_group *group)
{
    memcpy(out->channels[r], group->channels, sizeof out->channels[r]);
    out->components[r] = group->components;
}

static bool ends_in_any(const char *name, const char *const *patterns, int count)
{
    for (int p = 0; p < count && patterns[p]; p++) {
        size_t n = strlen(name), m = strlen(patterns[p]);
        if (n >= m && strcasecmp(name + n - m, patterns[p]) == 0 && (n == m || name[n - m - 1] == '.')) return true;
    }
    return false;
}

// The albedo's kind follows from the name it was found by, unless an option said it. A name given by the user is judged by the
// first row that knows it.
static albedo_kind albedo_named(const search *s, const convention *row, const char *name)
{
    if (s->options->albedo != ALBEDO_AUTO) return s->options->albedo;
    for (int i = 0; !row && name && i < convention_count; i++)
        if (ends_in_any(name, conventions[i].patterns[ROLE_ALBEDO], CONVENTION_PATTERNS)) row = &conventions[i];
    if (!row) row = s->row;
    const int count = (int)(sizeof row->diffuse_albedo / sizeof *row->diffuse_albedo);
    return name && ends_in_any(name, row->diffuse_albedo, count) ? ALBEDO_DIFFUSE : row->albedo;
}

static bool name_roles(const search *s, resolution *out)
{
    const named_search named = {&s->index, s->options, s->key, s->e};
    for (int r = 0; r < ROLE_COUNT; r++) {
        layer_group group;
        for (int c = 0; c < 4; c++) out->channels[r][c] = (channel_ref){-1, -1};
        if (!s->options->names[r]) continue;
        if (!named_find(&named, s->options->names[r], roles[r].kind, roles[r].flag, &group)) return false;
        take(out, (role)r, &group);
    }
    return true;
}

// Of a file whose channels name no geometry: Z without X and Y under any name, which the format calls depth, or what the file's
// own name says. Depth or position, whatever is found first.
static void guess_geometry(const search *s, resolution *out)
{
    static const role shapes[] = {ROLE_POSITION, ROLE_DEPTH};
    layer_group group;
    if (guess_lone_depth(&s->index, &group)) {
        take(out, ROLE_DEPTH, &group);
        return;
    }
    for (int i = 0; i < 2; i++)
        if (guess_by_file_name(&s->index, shapes[i], roles[shapes[i]].kind, &group)) {
            take(out, shapes[i], &group);
            return;
        }
}

// A depth found in the R of a picture: its G and B must say the same, which the pixels are asked.
static void take_grey(const search *s, resolution *out)
{
    channel_ref r = out->channels[ROLE_DEPTH][0], g = layers_sibling(&s->index, r, "G"), b = layers_sibling(&s->index, r, "B");
    channel_ref own = layers_sibling(&s->index, r, "R");
    if (own.part != r.part || own.channel != r.channel || g.part < 0 || b.part < 0) return;
    out->channels[ROLE_DEPTH][1] = g, out->channels[ROLE_DEPTH][2] = b, out->components[ROLE_DEPTH] = 3;
}

static bool find_roles(const search *s, resolution *out)
{
    if (!name_roles(s, out)) return false;
    for (int r = 0; r < ROLE_COUNT; r++) {
        layer_group group;
        const char *name = s->options->names[r];
        const convention *row = NULL;
        if (!name && detect(s, (role)r, out, &group, &row, &name)) take(out, (role)r, &group);
        if (r == ROLE_ALBEDO) out->albedo = albedo_named(s, row, name);
        if (r == ROLE_DEPTH && !out->components[ROLE_POSITION] && !out->components[ROLE_DEPTH]) guess_geometry(s, out);
        bool one = name && (name == s->options->names[r] || strchr(name, '/')); // a channel by its own name
        if (r == ROLE_DEPTH && out->components[ROLE_DEPTH] == 1 && !one) take_grey(s, out);
    }
    // The alpha that belongs to the beauty is the one in its own layer.
    if (out->components[ROLE_BEAUTY] && !s->options->names[ROLE_ALPHA]) {
        channel_ref a = layers_sibling(&s->index, out->channels[ROLE_BEAUTY][0], "A");
        if (a.part >= 0) out->channels[ROLE_ALPHA][0] = a, out->components[ROLE_ALPHA] = 1;
    }
    return true;
}

static bool no_geometry(const search *s)
{
    char has[LAYERS_TEXT];
    layers_list(&s->index, has, sizeof has);
    bool vector = false;
    for (int i = 0; i < s->index.count; i++)
        vector |= s->index.entries[i].bare && !s->index.entries[i].layer[0] && layers_has(&s->index, &s->index.entries[i], "XYZ");
    return err_set(s->e, ERR_INPUT, s->file->path, NULL,
                   "no position and no depth found (looked for Position, P, Depth, Z and the like); the file has %s; %s", has,
                   vector ? "X, Y and Z alone may be positions or a picture in CIE XYZ: --position X,Y,Z says the former"
                          : "name them with --position or --depth");
}

bool resolve_channels(const exrio_file *file, const resolve_options *options, resolution *out, log_t *log, error *e)
{
    search s = {.file = file, .options = options, .log = log, .e = e};
    bool done = false;
    *out = (resolution){0};
    if (!layers_index(file, options->view, &s.index, e)) return false;
    picture_mark(&s.index);
    choose_row(&s);
    if (!choose_key(&s) || !find_roles(&s, out)) goto out;
    bool has_position = out->components[ROLE_POSITION] > 0;
    if (!has_position && !out->components[ROLE_DEPTH]) {
        no_geometry(&s);
        goto out;
    }
    out->convention = s.row->name;
    out->mark = find_mark(file, s.row);
    snprintf(out->view_layer, sizeof out->view_layer, "%s", s.key);
    out->main_part = out->channels[has_position ? ROLE_POSITION : ROLE_DEPTH][0].part;
    out->depth = options->depth;
    out->depth_told = options->depth != DEPTH_AUTO;
    if (out->depth == DEPTH_AUTO && !has_position) out->depth = s.row->depth == DEPTH_AUTO ? DEPTH_PLANAR : s.row->depth;
    out->up_is_z = s.row->up_is_z;
    out->background_depth = s.row->background_depth;
    for (int r = 0; r < ROLE_COUNT; r++) {
        char line[512];
        resolve_describe(file, out, (role)r, line, sizeof line);
        if (out->components[r]) log_info(log, "%s", line);
    }
    done = true;
out:
    layers_free(&s.index);
    return done;
}

void resolve_describe(const exrio_file *file, const resolution *r, role which, char *buf, size_t size)
{
    static const char *const types[] = {[SAMPLE_UINT] = "uint", [SAMPLE_HALF] = "half", [SAMPLE_FLOAT] = "float"};
    if (r->components[which] == 0) {
        snprintf(buf, size, "%s: absent", roles[which].name);
        return;
    }
    const channel_ref *c = r->channels[which];
    const exrio_channel *first = &file->parts[c[0].part].channels[c[0].channel];
    char whole[600];
    layers_channel_name(file, c[0], whole, sizeof whole);
    int used = snprintf(buf, size, "%s: %s", roles[which].name, whole);
    for (int i = 1; i < r->components[which] && used > 0 && (size_t)used < size; i++) {
        const char *name = file->parts[c[i].part].channels[c[i].channel].name, *dot = strrchr(name, '.');
        used += snprintf(buf + used, size - (size_t)used, "/%s", dot ? dot + 1 : name);
    }
    if (used > 0 && (size_t)used < size)
        snprintf(buf + used, size - (size_t)used, " (part %d, %s)", c[0].part, types[first->type]);
}
