#include <stdio.h>
#include <stdlib.h>

#include "base/clock.h"
#include "base/mem.h"
#include "bench.h"

static GLuint compile(GLenum kind, const char *path, error *e)
{
    char text[4096] = "", message[400] = "";
    FILE *f = fopen(path, "rb");
    if (!f) {
        err_set(e, ERR_INPUT, path, NULL, "the yardstick's shader cannot be read; run from the project's top folder");
        return 0;
    }
    size_t n = fread(text, 1, sizeof text - 1, f);
    fclose(f);
    text[n] = 0;
    const char *source = text;
    GLuint shader = glCreateShader(kind);
    GLint ok = 0;
    glShaderSource(shader, 1, &source, NULL);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (ok) return shader;
    glGetShaderInfoLog(shader, sizeof message, NULL, message);
    glDeleteShader(shader);
    err_set(e, ERR_GL, path, NULL, "does not compile: %s", message);
    return 0;
}

static bool link_program(yardstick *y, error *e)
{
    GLuint v = compile(GL_VERTEX_SHADER, "tests/bench/yardstick.vert", e);
    GLuint f = compile(GL_FRAGMENT_SHADER, "tests/bench/yardstick.frag", e);
    GLint ok = 0;
    y->program = glCreateProgram();
    if (v) glAttachShader(y->program, v);
    if (f) glAttachShader(y->program, f);
    if (v && f) glLinkProgram(y->program);
    glGetProgramiv(y->program, GL_LINK_STATUS, &ok);
    if (v) glDeleteShader(v);
    if (f) glDeleteShader(f);
    return ok || err_set(e, ERR_GL, NULL, NULL, "the yardstick's program does not link");
}

static GLuint texture(int width, int height)
{
    GLuint id;
    glCreateTextures(GL_TEXTURE_2D, 1, &id);
    glTextureStorage2D(id, 1, GL_R32F, width, height);
    glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return id;
}

bool yardstick_open(yardstick *y, int width, int height, error *e)
{
    *y = (yardstick){.width = width, .height = height};
    if (!link_program(y, e)) return false;
    glCreateVertexArrays(1, &y->vertices);
    y->source = texture(width, height);
    y->target = texture(width, height);
    float *ramp = mem_pixels((size_t)width * (size_t)height, sizeof *ramp, e);
    if (!ramp) return false;
    for (int i = 0; i < width * height; i++) ramp[i] = (float)(i % 977) / 977.0f;
    glTextureSubImage2D(y->source, 0, 0, 0, width, height, GL_RED, GL_FLOAT, ramp);
    free(ramp);
    glCreateFramebuffers(1, &y->framebuffer);
    glNamedFramebufferTexture(y->framebuffer, GL_COLOR_ATTACHMENT0, y->target, 0);
    bool whole = glCheckNamedFramebufferStatus(y->framebuffer, GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    yardstick_run(y); // compiles
    return whole || err_set(e, ERR_GL, NULL, NULL, "this device cannot draw into an R32F texture");
}

bench_time yardstick_run(const yardstick *y)
{
    glFinish();
    double cpu = clock_cpu_ms(), wall = clock_wall_ms();
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, y->framebuffer);
    glViewport(0, 0, y->width, y->height);
    glUseProgram(y->program);
    glBindTextureUnit(0, y->source);
    glBindVertexArray(y->vertices);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glFinish();
    bench_time t = {clock_cpu_ms() - cpu, clock_wall_ms() - wall};
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    return t;
}

void yardstick_close(yardstick *y)
{
    glDeleteProgram(y->program);
    glDeleteVertexArrays(1, &y->vertices);
    glDeleteTextures(1, &y->source);
    glDeleteTextures(1, &y->target);
    glDeleteFramebuffers(1, &y->framebuffer);
}
