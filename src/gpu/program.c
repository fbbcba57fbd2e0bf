#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/infile.h"
#include "base/knobs.h"
#include "base/mem.h"
#include "gpu/cache.h"
#include "gpu/diagnose.h"
#include "gpu/gpu.h"
#include "gpu/internal.h"
#include "gpu/shaders.h"

enum { MAX_SOURCES = 32 };

// A growing text, and the files it was spliced from: GLSL's "#line n file" carries an index into `files`.
typedef struct splice {
    char *text;
    size_t length, capacity;
    const char *files[MAX_SOURCES];
    char *loaded[MAX_SOURCES]; // texts read from disk, to be freed
    int file_count;
} splice;

static bool append(splice *s, const char *text, size_t n, error *e)
{
    if (s->length + n + 1 > s->capacity) {
        size_t capacity = (s->length + n + 1) * 2;
        char *grown = mem_grow(s->text, capacity, 1, e);
        if (!grown) return false;
        s->text = grown;
        s->capacity = capacity;
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
    const char *dir = knob_value("SSDO_SHADER_DIR");
    if (dir && *dir) return s->loaded[s->file_count] = read_file(dir, name, e);
    for (const shader_source *p = shader_sources; p->name; p++)
        if (strcmp(p->name, name) == 0) return p->text;
    err_set(e, ERR_GL, name, NULL, "there is no shader of this name");
    return NULL;
}

static bool append_mark(splice *s, int line, int file, error *e)
{
    char mark[64];
    snprintf(mark, sizeof mark, "#line %d %d\n", line, file);
    return append(s, mark, strlen(mark), e);
}

static bool append_defines(splice *s, const char *defines, error *e)
{
    for (const char *d = defines; *d;) {
        size_t m = strcspn(d, "\n");
        if (m && (!append(s, "#define ", 8, e) || !append(s, d, m, e) || !append(s, "\n", 1, e))) return false;
        d += m + (d[m] == '\n');
    }
    return true;
}

// Whether lines that the preprocessor left out may end here.
static bool ends_part(const char *line)
{
    const char *p = line + strspn(line, " \t");
    if (*p++ != '#') return false;
    p += strspn(p, " \t");
    return strncmp(p, "else", 4) == 0 || strncmp(p, "elif", 4) == 0 || strncmp(p, "endif", 5) == 0;
}

static bool splice_file(splice *s, const char *name, const char *defines, error *e);

static bool splice_include(splice *s, const char *line, size_t n, error *e)
{
    const char *quote = memchr(line + 10, '"', n - 10);
    if (!quote) return err_set(e, ERR_GL, s->files[s->file_count - 1], NULL, "an #include has no closing quotation mark");
    char *included = mem_zero(n, 1, e);
    if (!included) return false;
    memcpy(included, line + 10, (size_t)(quote - line - 10));
    int before = s->file_count;
    // The name outlives this call inside `files`, unless the file was there already.
    bool ok = append_mark(s, 1, s->file_count, e) && splice_file(s, included, NULL, e);
    if (s->file_count == before) free(included);
    return ok;
}

// Splices the file's lines, following #include "..." once per file. A first line "#version" goes before the defines. The
// preprocessor skips a "#line" in a part that it leaves out, but counts what was spliced into it: so the place is told anew where
// such a part may end.
static bool splice_file(splice *s, const char *name, const char *defines, error *e)
{
    for (int i = 0; i < s->file_count; i++)
        if (strcmp(s->files[i], name) == 0) return true;
    if (s->file_count == MAX_SOURCES) return err_set(e, ERR_GL, name, NULL, "too many included shader files");
    const char *text = source_of(s, name, e);
    if (!text) return false;
    int index = s->file_count++;
    s->files[index] = name;
    int line = 1;
    for (const char *p = text; *p; line++) {
        size_t n = strcspn(p, "\n") + (strchr(p, '\n') != NULL);
        bool include = strncmp(p, "#include \"", 10) == 0, version = defines && strncmp(p, "#version", 8) == 0;
        bool ok = include ? splice_include(s, p, n, e) : append(s, p, n, e);
        ok = ok && (p[n - 1] == '\n' || append(s, "\n", 1, e)) && (!version || append_defines(s, defines, e));
        if (!ok || ((include || version || ends_part(p)) && !append_mark(s, line + 1, index, e))) return false;
        p += n;
    }
    return true;
}

// One triangle over the whole picture; the scissor cuts out the tile.
static const char vertex_text[] =
    "#version 450 core\n"
    "void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }\n";

typedef void (*get_iv)(GLuint, GLenum, GLint *);
typedef void (*get_log)(GLuint, GLsizei, GLsizei *, GLchar *);

// The whole log of a shader or program; NULL without memory.
static char *read_log(GLuint id, get_iv iv, get_log log, error *e)
{
    GLint size = 0;
    iv(id, GL_INFO_LOG_LENGTH, &size);
    char *text = mem_zero((size_t)(size > 0 ? size : 0) + 1, 1, e);
    if (text && size > 0) log(id, size, NULL, text);
    return text;
}

// False with the driver's log in *log.
static bool attach(GLuint program, GLenum kind, const char *text, char **log, error *e)
{
    GLuint shader = glCreateShader(kind);
    GLint ok = 0;
    glShaderSource(shader, 1, &text, NULL);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (ok)
        glAttachShader(program, shader);
    else
        *log = read_log(shader, glGetShaderiv, glGetShaderInfoLog, e);
    glDeleteShader(shader); // the program keeps what it was given
    return ok;
}

static bool link_program(GLuint program, char **log, error *e)
{
    GLint ok = 0;
    glProgramParameteri(program, GL_PROGRAM_BINARY_RETRIEVABLE_HINT, GL_TRUE);
    glLinkProgram(program);
    glGetProgramiv(program, GL_LINK_STATUS, &ok);
    if (!ok) *log = read_log(program, glGetProgramiv, glGetProgramInfoLog, e);
    return ok;
}

// The first error as "arc_light.comp:144: the driver refuses ...", the whole log to -v.
static void refuse(const gpu *g, const splice *s, const char *name, const char *log, error *e)
{
    enum { SHOWN = 400 };
    char file[256];
    diagnose_place place;
    char *all = diagnose_translate(log, s->files, s->file_count, e);
    for (const char *p = all; p && *p; p += strcspn(p, "\n"), p += *p == '\n')
        log_info(g->log, "shader %s: %.*s", name, (int)strcspn(p, "\n"), p);
    free(all);
    bool placed = diagnose_first(log, &place) && place.file < s->file_count;
    const char *text = placed ? place.text : log;
    size_t n = strcspn(text, "\n");
    if (placed)
        snprintf(file, sizeof file, "%s:%d", s->files[place.file], place.line);
    else
        snprintf(file, sizeof file, "%s", name), n = strlen(text);
    err_set(e, ERR_GL, file, NULL, "the driver refuses shader %s: %.*s%s; -v shows all it says", name,
            (int)(n < SHOWN ? n : SHOWN), text, n < SHOWN ? "" : "...");
}

static GLuint compile(gpu *g, const splice *s, const char *name, bool drawn, error *e)
{
    GLuint program = glCreateProgram();
    char *log = NULL;
    g->source_files = s->files, g->source_count = s->file_count; // for the driver's messages
    bool ok = (!drawn || attach(program, GL_VERTEX_SHADER, vertex_text, &log, e)) &&
              attach(program, drawn ? GL_FRAGMENT_SHADER : GL_COMPUTE_SHADER, s->text, &log, e) && link_program(program, &log, e);
    g->source_files = NULL;
    if (!ok) {
        refuse(g, s, name, log ? log : "", e);
        glDeleteProgram(program);
        program = 0;
    }
    free(log);
    return program;
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
    program = compile(g, s, name, drawn, e);
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
    if (ok) gpu_label(g, GL_PROGRAM, p->id, name);
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
