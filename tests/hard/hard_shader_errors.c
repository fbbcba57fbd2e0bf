// An error in any line of any shader is reported with that file and line: a token that GLSL does not have is put before each line
// of code, in a copy of the shaders, and a program compiled in which the line is not left out. All lines with SSDO_HARD=whole,
// else every SAMPLEth of a file and the last ones.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "gpu/internal.h"
#include "gpu/shaders.h"
#include "hard.h"
#include "passes/variants.h"

enum { SAMPLE = 17, LAST = 3, PATH = 256, CANDIDATES = 8192 };

typedef struct candidate {
    const variant_row *row;
    char words[VARIANT_TEXT];
} candidate;

typedef struct bench {
    char folder[PATH];
    gpu g;
    log_t log;
    candidate list[CANDIDATES]; // the programs that a file is in
    int count, lines, compiled;
    const variant_row *row; // being listed
} bench;

static const char *text_of(const char *name)
{
    for (const shader_source *s = shader_sources; s->name; s++)
        if (strcmp(s->name, name) == 0) return s->text;
    fail_msg("there is no shader %s", name);
    return NULL;
}

// Whether a file is `wanted` or includes it, directly or not.
static bool includes(const char *name, const char *wanted)
{
    char other[PATH];
    if (strcmp(name, wanted) == 0) return true;
    for (const char *p = text_of(name); (p = strstr(p, "#include \"")); p++)
        if (sscanf(p, "#include \"%255[^\"]", other) == 1 && includes(other, wanted)) return true;
    return false;
}

static bool add_candidate(void *context, const char *words)
{
    bench *b = context;
    assert_true(b->count < CANDIDATES);
    b->list[b->count].row = b->row;
    snprintf(b->list[b->count++].words, VARIANT_TEXT, "%s", words);
    return true;
}

// Programs of more words come first: less is left out of them.
static int by_words(const void *a, const void *b)
{
    size_t na = strlen(((const candidate *)a)->words), nb = strlen(((const candidate *)b)->words);
    return na < nb ? 1 : na > nb ? -1 : strcmp(((const candidate *)a)->words, ((const candidate *)b)->words);
}

static void list_candidates(bench *b, const char *file)
{
    char name[PATH];
    b->count = 0;
    for (int i = 0; (b->row = variant_row_at(i)); i++) {
        snprintf(name, sizeof name, "%s.comp", b->row->program);
        if (includes(name, file)) must(variant_each(b->row, add_candidate, b), NULL);
    }
    qsort(b->list, (size_t)b->count, sizeof *b->list, by_words);
}

static void write_shader(const bench *b, const char *name, const char *head, const char *middle, const char *tail)
{
    char path[2 * PATH];
    snprintf(path, sizeof path, "%s/%s", b->folder, name);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fprintf(f, "%.*s%s%s", (int)(tail - head), head, middle, tail);
    assert_int_equal(fclose(f), 0);
}

// Whether the program is refused; then *e says why.
static bool refused(bench *b, const candidate *c, error *e)
{
    char file[PATH], defines[2 * VARIANT_TEXT];
    snprintf(file, sizeof file, "%s.comp", c->row->program);
    assert_true(variant_defines(c->words, defines, sizeof defines));
    *e = (error){0};
    b->compiled++;
    bool drawn = c->row->drawable && b->compiled % 2 == 0;
    bool ok = gpu_program_get(&b->g, file, defines, drawn, e) != NULL;
    gpu_programs_free(&b->g);
    return !ok;
}

static void check_line(bench *b, const char *file, const char *text, const char *at, int line)
{
    char wanted[PATH];
    error e;
    int i = 0;
    write_shader(b, file, text, "@ ", at);
    while (i < b->count && !refused(b, &b->list[i], &e)) i++;
    if (i == b->count) fail_msg("%s:%d is in no program", file, line);
    snprintf(wanted, sizeof wanted, "%s:%d", file, line);
    if (strcmp(e.file, wanted) != 0 || e.code != ERR_GL)
        fail_msg("an error at %s, in %s %s, is reported at %s: %s", wanted, b->list[i].row->program, b->list[i].words, e.file,
                 e.message);
    candidate found = b->list[i]; // the next line's first try
    memmove(b->list + 1, b->list, (size_t)i * sizeof *b->list);
    b->list[0] = found;
    b->lines++;
}

// Comments, empty lines and directives are no code, but #include is.
static bool is_code(const char *line)
{
    const char *p = line + strspn(line, " \t");
    return *p != '\n' && strncmp(p, "//", 2) != 0 && (*p != '#' || strncmp(p, "#include", 8) == 0);
}

static void check_file(bench *b, const char *file, const char *text)
{
    int line = 1, total = 0;
    for (const char *p = text; *p; p++) total += *p == '\n';
    list_candidates(b, file);
    if (b->count == 0) fail_msg("%s is in no program", file);
    for (const char *p = text; *p; p = strchr(p, '\n') + 1, line++) {
        bool wanted = hard_whole() || line % SAMPLE == 0 || line > total - LAST;
        const char *end = strchr(p, '\n');
        bool continued = p > text + 1 && p[-2] == '\\'; // a macro's further lines are reported where it is used
        assert_non_null(end);
        if (wanted && is_code(p) && !continued) check_line(b, file, text, p, line);
    }
    write_shader(b, file, text, "", text);
}

static void every_line_is_reported(void **state)
{
    bench *b = *state;
    for (const shader_source *s = shader_sources; s->name; s++) check_file(b, s->name, s->text);
    printf("figure: errors in %d lines of shaders, each reported at its line (%d programs compiled)\n", b->lines, b->compiled);
}

static int set_up(void **state)
{
    static bench b;
    error e = {0};
    char path[2 * PATH];
    snprintf(b.folder, sizeof b.folder, "%s/ssdo-shaders-XXXXXX", access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp");
    if (!mkdtemp(b.folder)) return -1;
    static const char *const folders[] = {"include", "params"};
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) {
        snprintf(path, sizeof path, "%s/%s", b.folder, folders[i]);
        if (mkdir(path, 0700) != 0) return -1;
    }
    for (const shader_source *s = shader_sources; s->name; s++) write_shader(&b, s->name, s->text, "", s->text);
    setenv("SSDO_SHADER_DIR", b.folder, 1);
    setenv("XDG_CACHE_HOME", b.folder, 1);
    log_init(&b.log, LOG_QUIET);
    must(gpu_open(&b.g, -1, &b.log, &e), &e);
    *state = &b;
    return 0;
}

static int tear_down(void **state)
{
    bench *b = *state;
    char command[PATH + 16];
    gpu_close(&b->g);
    log_free(&b->log);
    snprintf(command, sizeof command, "rm -rf '%s'", b->folder);
    return system(command);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_line_is_reported)};
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
