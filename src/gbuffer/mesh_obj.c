#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "gbuffer/mesh.h"

typedef struct reader {
    const char *path;
    mesh_lines lines;
    obj_mesh *m;
    float (*colours)[3]; // of each vertex; red < 0: none
    size_t vertex_capacity, triangle_capacity;
    unsigned *corners; // of the face being read
    unsigned (*cut)[3];
    size_t corner_capacity;
    mesh_materials materials;
    float kd[3]; // of the material in use
    log_t *log;
    error *e;
} reader;

static bool fail(const reader *r, const char *what)
{
    return err_set(r->e, ERR_INPUT, r->path, NULL, "line %zu: %s; export the mesh again as a plain OBJ file", r->lines.number,
                   what);
}

static bool room_for_vertex(reader *r)
{
    if (r->m->vertex_count < r->vertex_capacity) return true;
    size_t capacity = 2 * r->vertex_capacity + 1024;
    vec3 *v = mem_grow(r->m->vertices, capacity, sizeof *v, r->e);
    if (v) r->m->vertices = v;
    float(*c)[3] = v ? mem_grow(r->colours, capacity, sizeof *c, r->e) : NULL;
    if (c) r->colours = c, r->vertex_capacity = capacity;
    return c != NULL;
}

static bool room_for_triangles(reader *r, size_t n)
{
    if (r->m->triangle_count + n <= r->triangle_capacity) return true;
    size_t capacity = 2 * r->triangle_capacity + n + 1024;
    unsigned(*t)[3] = mem_grow(r->m->triangles, capacity, sizeof *t, r->e);
    if (t) r->m->triangles = t;
    float(*a)[3] = t ? mem_grow(r->m->albedo, capacity, sizeof *a, r->e) : NULL;
    if (a) r->m->albedo = a, r->triangle_capacity = capacity;
    return a != NULL;
}

static float share(double v) { return v > 0.0 ? (v < 1.0 ? (float)v : 1.0f) : 0.0f; }

// x y z, then nothing, a weight, a colour, or a weight and a colour.
static bool read_vertex(reader *r, char *rest)
{
    double v[7];
    int n = 0;
    while (*rest && n < 7) {
        char *end;
        v[n] = strtod(rest, &end);
        if (end == rest || !isfinite(v[n])) return fail(r, "a vertex holds what is not a finite number");
        rest = end + strspn(end, " \t");
        n++;
    }
    if (n < 3) return fail(r, "a vertex has fewer than three coordinates");
    if (r->m->vertex_count == 0xffffffffu) return fail(r, "the mesh has too many vertices");
    if (!room_for_vertex(r)) return false;
    float *c = r->colours[r->m->vertex_count];
    const double *rgb = n >= 6 ? v + n - 3 : NULL;
    for (int k = 0; k < 3; k++) c[k] = rgb ? share(rgb[k]) : -1.0f;
    r->m->coloured |= rgb != NULL;
    r->m->vertices[r->m->vertex_count++] = v3(v[0], v[1], v[2]);
    return true;
}

// "7", "7/1", "7//2", "7/1/2", "-1": only the vertex counts.
static bool read_corner(reader *r, char **at, unsigned *out)
{
    char *end;
    long i = strtol(*at, &end, 10);
    if (end == *at || (*end && !strchr("/ \t", *end))) return fail(r, "a face holds what is not an index");
    long count = (long)r->m->vertex_count, index = i > 0 ? i - 1 : count + i;
    if (i == 0 || index < 0 || index >= count) {
        char what[120];
        snprintf(what, sizeof what, "a face names vertex %ld, and there are %ld before it", i, count);
        return fail(r, what);
    }
    *out = (unsigned)index;
    end += strcspn(end, " \t");
    *at = end + strspn(end, " \t");
    return true;
}

static void colour_of(const reader *r, const unsigned t[3], float out[3])
{
    for (int k = 0; k < 3; k++) {
        float sum = 0.0f;
        bool all = true;
        for (int c = 0; c < 3; c++) sum += r->colours[t[c]][k], all &= r->colours[t[c]][0] >= 0.0f;
        out[k] = all ? sum / 3.0f : r->kd[k];
    }
}

static bool has_area(const vec3 *v, const unsigned t[3])
{
    vec3 n = v3_cross(v3_sub(v[t[1]], v[t[0]]), v3_sub(v[t[2]], v[t[0]]));
    return v3_length(n) > 0.0;
}

static bool room_for_corner(reader *r, size_t n)
{
    if (n < r->corner_capacity) return true;
    size_t capacity = 2 * r->corner_capacity + 16;
    unsigned *c = mem_grow(r->corners, capacity, sizeof *c, r->e);
    if (c) r->corners = c;
    unsigned(*t)[3] = c ? mem_grow(r->cut, capacity, sizeof *t, r->e) : NULL;
    if (t) r->cut = t, r->corner_capacity = capacity;
    return t != NULL;
}

static bool read_face(reader *r, char *rest)
{
    size_t n = 0;
    for (; *rest; n++)
        if (!room_for_corner(r, n) || !read_corner(r, &rest, &r->corners[n])) return false;
    if (n < 3) return fail(r, "a face has fewer than three corners");
    if (!room_for_triangles(r, n)) return false;
    obj_mesh *m = r->m;
    if (m->triangle_count + n > 0x7ffffff0u) return fail(r, "the mesh has too many triangles");
    if (!mesh_cut_polygon(m->vertices, r->corners, n, r->cut, r->e)) {
        char what[120];
        snprintf(what, sizeof what, "a face of %zu corners is too tangled to be cut into triangles", n);
        return fail(r, what);
    }
    for (size_t i = 0; i + 2 < n; i++) {
        if (!has_area(m->vertices, r->cut[i])) continue;
        colour_of(r, r->cut[i], m->albedo[m->triangle_count]);
        memcpy(m->triangles[m->triangle_count++], r->cut[i], sizeof r->cut[i]);
    }
    return true;
}

// Missing colours are no reason to stop; that the system does not let us look for them is.
static bool use_library(reader *r, const char *name)
{
    char path[4096];
    error e = {0};
    mesh_library_path(r->path, name, path, sizeof path);
    if (mesh_read_mtl(path, &r->materials, &e)) return true;
    if (e.code == ERR_MEMORY) return err_set(r->e, e.code, NULL, NULL, "%s", e.message);
    if (e.refused) return err_set_system(r->e, ERR_INPUT, e.refused, path, "the material file cannot be read");
    if (r->log) log_warn(r->log, path, "%s: %s; surfaces without a colour reflect %g", path, e.message, (double)MESH_GREY);
    return true;
}

static void use_material(reader *r, const char *name)
{
    for (int k = 0; k < 3; k++) r->kd[k] = MESH_GREY;
    for (size_t i = 0; i < r->materials.count; i++)
        if (strcmp(r->materials.list[i].name, name) == 0) memcpy(r->kd, r->materials.list[i].kd, sizeof r->kd);
}

static bool read_lines(reader *r)
{
    char *line, *rest;
    bool ok = true;
    while (ok && (line = mesh_next_line(&r->lines))) {
        if ((rest = mesh_after_word(line, "v")))
            ok = read_vertex(r, rest);
        else if ((rest = mesh_after_word(line, "f")))
            ok = read_face(r, rest);
        else if ((rest = mesh_after_word(line, "usemtl")))
            use_material(r, rest);
        else if ((rest = mesh_after_word(line, "mtllib")))
            ok = use_library(r, rest);
    }
    if (ok && r->m->triangle_count == 0)
        ok = err_set(r->e, ERR_INPUT, r->path, NULL, "holds no face with an area; export the scene's surfaces as an OBJ mesh");
    return ok;
}

bool mesh_read_obj(const char *path, obj_mesh *out, log_t *log, error *e)
{
    reader r = {.path = path, .m = out, .kd = {MESH_GREY, MESH_GREY, MESH_GREY}, .log = log, .e = e};
    *out = (obj_mesh){0};
    char *text = mesh_read_text(path, e);
    r.lines = (mesh_lines){text, 0};
    bool ok = text && read_lines(&r);
    out->coloured |= r.materials.count > 0;
    if (ok && r.materials.textured && log)
        log_warn(log, "map_Kd", "%s: its materials have textures, which are not read; each surface sends its Kd", path);
    mesh_materials_free(&r.materials);
    free(r.colours);
    free(r.corners);
    free(r.cut);
    free(text);
    if (!ok) mesh_free(out);
    return ok;
}

void mesh_free(obj_mesh *m)
{
    free(m->vertices);
    free(m->triangles);
    free(m->albedo);
    *m = (obj_mesh){0};
}
