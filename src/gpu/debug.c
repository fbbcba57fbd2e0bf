#include <stdlib.h>
#include <string.h>

#include "gpu/diagnose.h"
#include "gpu/internal.h"

static const char *severity_name(GLenum severity)
{
    if (severity == GL_DEBUG_SEVERITY_HIGH) return "error";
    if (severity == GL_DEBUG_SEVERITY_MEDIUM) return "warning";
    return severity == GL_DEBUG_SEVERITY_LOW ? "remark" : "note";
}

// A message a line, with the names of shaders' files while one is compiled.
static void GLAPIENTRY on_message(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length, const GLchar *text,
                                  const void *user)
{
    const gpu *g = user;
    error ignored = {0};
    (void)type, (void)id, (void)length;                // the text is terminated
    if (source == GL_DEBUG_SOURCE_APPLICATION) return; // our own groups
    char *named = g->source_files ? diagnose_translate(text, g->source_files, g->source_count, &ignored) : NULL;
    for (const char *p = named ? named : text; *p; p += strcspn(p, "\n"), p += *p == '\n')
        if (*p != '\n')
            log_error(g->log, "gpu %s%s%s: %.*s", severity_name(severity), g->group ? " in " : "", g->group ? g->group : "",
                      (int)strcspn(p, "\n"), p);
    free(named);
}

void gpu_debug_begin(gpu *g)
{
    if (!g->log) return;
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS); // so that a message comes from the call that it is about
    glDebugMessageCallback(on_message, g);
    glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, NULL, GL_TRUE);
}

void gpu_group_begin(gpu *g, const char *name)
{
    g->group = name;
    if (g->debug) glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, -1, name);
}

void gpu_group_end(gpu *g)
{
    g->group = NULL;
    if (g->debug) glPopDebugGroup();
}

void gpu_label(const gpu *g, GLenum kind, GLuint id, const char *name)
{
    if (g->debug && id) glObjectLabel(kind, id, -1, name);
}
