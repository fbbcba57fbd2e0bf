#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/infile.h"
#include "base/mem.h"
#include "gbuffer/mesh.h"

char *mesh_read_text(const char *path, error *e)
{
    return infile_text(path, (infile_kind){NULL, ERR_INPUT}, mem_available(), NULL, e);
}

static bool blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

// A material may be called "Paint#2".
static void cut_comment(char *line)
{
    for (char *p = line; (p = strchr(p, '#')); p++)
        if (p == line || blank(p[-1])) {
            *p = 0;
            return;
        }
}

char *mesh_next_line(mesh_lines *l)
{
    if (!*l->at) return NULL;
    char *line = l->at, *p = line;
    for (; *p; p++) {
        if (*p == '\\' && (p[1] == '\n' || (p[1] == '\r' && p[2] == '\n'))) {
            bool two = p[1] == '\r';
            p[0] = p[1] = ' ';
            if (two) p[2] = ' ', p++;
            p++;
            l->number++;
        } else if (*p == '\n') {
            break;
        }
    }
    l->at = *p ? p + 1 : p;
    *p = 0;
    l->number++;
    while (blank(*line)) line++;
    cut_comment(line);
    for (size_t n = strlen(line); n && blank(line[n - 1]); n--) line[n - 1] = 0;
    return line;
}

char *mesh_after_word(char *line, const char *word)
{
    size_t n = strlen(word);
    if (strncmp(line, word, n) != 0 || !blank(line[n])) return NULL;
    line += n;
    while (blank(*line)) line++;
    return line;
}

static bool add(mesh_materials *t, const char *name, error *e)
{
    mesh_material *grown = mem_grow(t->list, t->count + 1, sizeof *grown, e);
    if (!grown) return false;
    t->list = grown;
    t->list[t->count] = (mesh_material){mem_string(name, e), {MESH_GREY, MESH_GREY, MESH_GREY}};
    return t->list[t->count].name && ++t->count;
}

bool mesh_read_mtl(const char *path, mesh_materials *t, error *e)
{
    char *text = mesh_read_text(path, e), *line, *rest;
    bool ok = text != NULL;
    size_t before = t->count;
    for (mesh_lines l = {text, 0}; ok && (line = mesh_next_line(&l));) {
        if ((rest = mesh_after_word(line, "newmtl"))) {
            ok = add(t, rest, e);
        } else if (mesh_after_word(line, "map_Kd")) {
            t->textured = true;
        } else if ((rest = mesh_after_word(line, "Kd")) && t->count > before) {
            float *kd = t->list[t->count - 1].kd;
            int n = sscanf(rest, "%f %f %f", &kd[0], &kd[1], &kd[2]);
            if (n == 1) kd[1] = kd[2] = kd[0]; // Wavefront: green and blue default to red
            for (int k = 0; k < 3; k++) kd[k] = kd[k] >= 0.0f ? (kd[k] <= 1.0f ? kd[k] : 1.0f) : 0.0f;
            if (n != 1 && n != 3)
                ok = err_set(e, ERR_INPUT, path, NULL, "line %zu: Kd needs three numbers; only the RGB form is read", l.number);
        }
    }
    free(text);
    return ok;
}

void mesh_materials_free(mesh_materials *t)
{
    for (size_t i = 0; i < t->count; i++) free(t->list[i].name);
    free(t->list);
    *t = (mesh_materials){0};
}

void mesh_library_path(const char *mesh, const char *name, char *path, size_t size)
{
    const char *slash = strrchr(mesh, '/');
    int folder = slash && name[0] != '/' ? (int)(slash - mesh) + 1 : 0;
    snprintf(path, size, "%.*s%s", folder, mesh, name);
}

bool mesh_list_libraries(const char *mesh, char ***list, int *count, error *e)
{
    char *text = mesh_read_text(mesh, e), *line, *name, path[4096];
    mesh_lines lines = {text, 0};
    bool ok = text != NULL;
    *list = NULL;
    *count = 0;
    while (ok && (line = mesh_next_line(&lines))) {
        if (!(name = mesh_after_word(line, "mtllib"))) continue;
        char **grown = mem_grow(*list, (size_t)*count + 1, sizeof *grown, e);
        mesh_library_path(mesh, name, path, sizeof path);
        ok = grown != NULL;
        if (ok) *list = grown;
        ok = ok && (grown[*count] = mem_string(path, e));
        if (ok) ++*count;
    }
    free(text);
    if (ok) return true;
    for (int i = 0; i < *count; i++) free((*list)[i]);
    free(*list);
    *list = NULL;
    *count = 0;
    return false;
}
