#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/infile.h"
#include "base/mem.h"
#include "gpu/cache.h"
#include "gpu/gpu.h"
#include "gpu/internal.h"
#include "gpu/shaders.h"

enum { MAX_SOURCES = 24 };

// A growing text, and the files it was spliced from: GLSL's "#line n file" carries an index into `files`.
typedef struct splice {
    char *text;
    size_t length, room;
    const char *files[MAX_SOURCES];
    char *loaded[MAX_SOURCES]; // texts read from disk, to be freed
    int file_count;
} splice;

static bool append(splice *s, const char *text, size_t n, error *e)
{
    if (s->length + n + 1 > s->room) {
        size_t room = (s->length + n + 1) * 2;
        char *grown = mem_grow(s->text, room, 1, e);
        if (!grown) return false;
        s->text = grown;
        s->room = room;
    }
    memcpy(s->text + s->length, text, n);
    s->length += n;
    s->text[s->length] = 0;
    return true;
}

static char *read_file(const char *dir, const char *name, error *e)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", dir, name);
    error why = {0};
    char *text = infile_text(path, (infile_kind){NULL, ERR_GL}, 1 << 20, NULL, &why);
    if (!text)
        err_set(e, why.code, path, NULL, "this shader cannot be read; SSDO_SHADER_DIR must name the project's shaders folder");
    return text;
}

static const char *source_of(splice *s, const char *name, error *e)
{
    const char *dir = getenv("SSDO_SHADER_DIR");
    if (dir && *dir) return s->loaded[s->file_count] = read_file(dir, name, e);
    for (const shader_source *p = shader_sources; p->name; p++)
        if (strcmp(p->name, name) == 0) return p->text;
    err_set(e, ERR_GL, name, NULL, "there is no shader of this name");
    return NULL;
}

// Splices the file's lines, following #include "..." once per file. A first line "#version" goes before the defines.
static bool splice_file(splice *s, const char *name, const char *defines, error *e)
{
    for (int i = 0; i < s->file_count; i++)
        if (strcmp(s->files[i], name) == 0) return true;
    if (s->file_count == MAX_SOURCES) return err_set(e, ERR_GL, name, NULL, "too many included shader files");
    const char *text = source_of(s, name, e);
    if (!text) return false;
    int index = s->file_count++;
    s->files[index] = name;
    char line_mark[64];
    int line = 1;
    for (const char *p = text; *p; line++) {
        const char *end = strchr(p, '\n');
        size_t n = end ? (size_t)(end - p) + 1 : strlen(p);
        if (strncmp(p, "#include \"", 10) == 0) {
            const char *quote = strchr(p + 10, '"');
            char *included = mem_zero(n, 1, e);
            if (!included || !quote) return false;
            memcpy(included, p + 10, (size_t)(quote - p - 10));
            snprintf(line_mark, sizeof line_mark, "#line 1 %d\n", s->file_count);
            // The name outlives this call inside `files`; MAX_SOURCES bounds what is kept, freed with the process's programs.
            bool ok = append(s, line_mark, strlen(line_mark), e) && splice_file(s, included, NULL, e);
            snprintf(line_mark, sizeof line_mark, "#line %d %d\n", line + 1, index);
            if (!ok || !append(s, line_mark, strlen(line_mark), e)) return false;
        } else if (!append(s, p, n, e)) {
            return false;
        } else if (strncmp(p, "#version", 8) == 0 && defines) {
            for (const char *d = defines; *d;) {
                size_t m = strcspn(d, "\n");
                if (m && (!append(s, "#define ", 8, e) || !append(s, d, m, e) || !append(s, "\n", 1, e))) return false;
                d += m + (d[m] == '\n');
            }
            if (!append(s, "#line 2 0\n", 10, e)) return false;
        }
        p += n;
    }
    return true;
}

// One triangle over the whole picture; the scissor cuts out the tile.
static const char vertex_text[] =
    "#version 450 core\n"
    "void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }\n";

static bool attach(GLuint program, GLenum kind, const char *text, char *message, GLsizei size)
{
    GLuint shader = glCreateShader(kind);
    GLint ok = 0;
    glShaderSource(shader, 1, &text, NULL);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (ok)
        glAttachShader(program, shader);
    else
        glGetShaderInfoLog(shader, size, NULL, message);
    glDeleteShader(shader); // the program keeps what it was given
    return ok;
}

static GLuint compile(const splice *s, const char *name, bool drawn, error *e)
{
    GLuint program = glCreateProgram();
    char message[400] = "";
    GLint ok = drawn ? attach(program, GL_VERTEX_SHADER, vertex_text, message, sizeof message) &&
                           attach(program, GL_FRAGMENT_SHADER, s->text, message, sizeof message)
                     : attach(program, GL_COMPUTE_SHADER, s->text, message, sizeof message);
    if (ok) {
        glProgramParameteri(program, GL_PROGRAM_BINARY_RETRIEVABLE_HINT, GL_TRUE);
        glLinkProgram(program);
        glGetProgramiv(program, GL_LINK_STATUS, &ok);
        if (!ok) glGetProgramInfoLog(program, sizeof message, NULL, message);
    }
    if (ok) return program;
    glDeleteProgram(program);
    int file = 0; // messages start with the file's number: "2:14(5): error"
    sscanf(message, "%d", &file);
    if (file < 0 || file >= s->file_count) file = 0;
    err_set(e, ERR_GL, s->files[file], NULL, "the driver refuses shader %s: %.300s", name, message);
    return 0;
}

// From the cache, else compiled and put there.
static GLuint fetch(gpu *g, const splice *s, const char *name, bool drawn, error *e)
{
    GLuint program = glCreateProgram();
    if (cache_load(g, s->text, program)) {
        g->programs_cached++;
        return program;
    }
    glDeleteProgram(program);
    program = compile(s, name, drawn, e);
    if (!program) return 0;
    g->programs_compiled++;
    cache_store(g, s->text, program);
    return program;
}

static void free_splice(splice *s)
{
    for (int i = 0; i < s->file_count; i++) {
        free(s->loaded[i]);
        if (i > 0) free((char *)s->files[i]);
    }
    free(s->text);
    *s = (splice){0};
}

// The file with its includes, after the defines of the caller, the form and the device's habits.
static bool splice_program(splice *s, gpu_habits habits, const char *name, const char *defines, bool drawn, error *e)
{
    char all[768];
    int n = snprintf(all, sizeof all, "%s%s%s", habits.read_images ? "READ_IMAGES 1\n" : "", drawn ? "FRAGMENT 1\n" : "",
                     defines ? defines : "");
    if (n < 0 || (size_t)n >= sizeof all) return err_set(e, ERR_GL, name, NULL, "this shader has too many defines");
    return splice_file(s, name, all, e);
}

char *gpu_program_source(gpu_habits habits, const char *name, const char *defines, bool drawn, error *e)
{
    splice s = {0};
    char *text = splice_program(&s, habits, name, defines, drawn, e) ? s.text : NULL;
    if (text) s.text = NULL;
    free_splice(&s);
    return text;
}

static void free_program(gpu_program *p)
{
    if (!p) return;
    if (p->id) glDeleteProgram(p->id);
    free(p->key);
    free(p);
}

static gpu_program *make_program(gpu *g, const char *key, const char *name, const char *defines, bool drawn, error *e)
{
    splice s = {0};
    gpu_program *p = mem_zero(1, sizeof *p, e);
    bool ok = p && (p->key = mem_string(key, e)) && splice_program(&s, g->habits, name, defines, drawn, e) &&
              (p->id = fetch(g, &s, name, drawn, e)) != 0;
    free_splice(&s);
    if (ok) p->drawn = drawn;
    if (ok && !gpu_find_slots(p))
        ok = err_set(e, ERR_GL, name, NULL, "this shader uses more than %d pictures, buffers and outputs", GPU_MAX_SLOTS);
    if (ok) return p;
    free_program(p);
    return NULL;
}

const gpu_program *gpu_program_get(gpu *g, const char *name, const char *defines, bool drawn, error *e)
{
    char key[512];
    snprintf(key, sizeof key, "%s%s\n%s", drawn ? "drawn " : "", name, defines ? defines : "");
    for (int i = 0; i < g->program_count; i++)
        if (strcmp(g->programs[i]->key, key) == 0) return g->programs[i];
    gpu_program **grown = mem_grow(g->programs, (size_t)g->program_count + 1, sizeof *grown, e);
    if (!grown) return NULL;
    g->programs = grown;
    gpu_program *p = make_program(g, key, name, defines, drawn, e);
    if (p) g->programs[g->program_count++] = p;
    return p;
}

void gpu_programs_free(gpu *g)
{
    for (int i = 0; i < g->program_count; i++) free_program(g->programs[i]);
    free(g->programs);
    g->programs = NULL;
    g->program_count = 0;
}
