// The places where a program takes its pictures, buffers and outputs. Shaders name none of them by number: units are given out
// here, in the order in which GL lists what the program uses, so that no two can meet and no pass has to count.
#include <stdio.h>
#include <string.h>

#include "gpu/internal.h"

// True where the program has a slot to spare; a program of ours has far fewer.
static bool add(gpu_program *p, const char *name, gpu_slot_kind kind, int unit)
{
    if (p->slot_count == GPU_MAX_SLOTS) return false;
    gpu_slot *s = &p->slots[p->slot_count++];
    snprintf(s->name, sizeof s->name, "%s", name);
    s->kind = kind, s->unit = unit;
    return true;
}

static bool is_sampler(GLenum type) { return type == GL_SAMPLER_2D || type == GL_UNSIGNED_INT_SAMPLER_2D; }
static bool is_image(GLenum type) { return type == GL_IMAGE_2D || type == GL_UNSIGNED_INT_IMAGE_2D; }

static bool find_pictures(gpu_program *p)
{
    GLint count = 0;
    int samplers = 0, images = 0;
    glGetProgramInterfaceiv(p->id, GL_UNIFORM, GL_ACTIVE_RESOURCES, &count);
    for (GLint i = 0; i < count; i++) {
        static const GLenum wanted[] = {GL_TYPE, GL_LOCATION};
        GLint got[2] = {0, -1};
        char name[sizeof p->slots->name];
        glGetProgramResourceiv(p->id, GL_UNIFORM, (GLuint)i, 2, wanted, 2, NULL, got);
        bool sampler = is_sampler((GLenum)got[0]);
        if (!sampler && !is_image((GLenum)got[0])) continue;
        glGetProgramResourceName(p->id, GL_UNIFORM, (GLuint)i, sizeof name, NULL, name);
        int unit = sampler ? samplers++ : images++;
        glProgramUniform1i(p->id, got[1], unit);
        if (!add(p, name, sampler ? SLOT_TEXTURE : SLOT_IMAGE, unit)) return false;
    }
    return true;
}

static bool find_buffers(gpu_program *p)
{
    GLint count = 0;
    glGetProgramInterfaceiv(p->id, GL_SHADER_STORAGE_BLOCK, GL_ACTIVE_RESOURCES, &count);
    for (GLint i = 0; i < count; i++) {
        char name[sizeof p->slots->name];
        glGetProgramResourceName(p->id, GL_SHADER_STORAGE_BLOCK, (GLuint)i, sizeof name, NULL, name);
        glShaderStorageBlockBinding(p->id, (GLuint)i, (GLuint)i);
        if (!add(p, name, SLOT_BUFFER, i)) return false;
    }
    return true;
}

// Outputs of a drawn program; a dispatched one has images instead.
static bool find_outputs(gpu_program *p)
{
    GLint count = 0;
    glGetProgramInterfaceiv(p->id, GL_PROGRAM_OUTPUT, GL_ACTIVE_RESOURCES, &count);
    for (GLint i = 0; i < count; i++) {
        char name[sizeof p->slots->name];
        glGetProgramResourceName(p->id, GL_PROGRAM_OUTPUT, (GLuint)i, sizeof name, NULL, name);
        if (!add(p, name, SLOT_OUTPUT, glGetProgramResourceLocation(p->id, GL_PROGRAM_OUTPUT, name))) return false;
    }
    return true;
}

bool gpu_find_slots(gpu_program *p)
{
    p->slot_count = 0;
    return find_pictures(p) && find_buffers(p) && (!p->drawn || find_outputs(p));
}

const gpu_slot *gpu_slot_of(const gpu_program *p, const char *name)
{
    for (int i = 0; i < p->slot_count; i++)
        if (strcmp(p->slots[i].name, name) == 0) return &p->slots[i];
    return NULL;
}

void gpu_bind_picture(const gpu_slot *s, const gpu_image *image)
{
    if (s->kind == SLOT_TEXTURE)
        glBindTextureUnit((GLuint)s->unit, image->id);
    else if (s->kind == SLOT_IMAGE && image->id)
        glBindImageTexture((GLuint)s->unit, image->id, 0, GL_FALSE, 0, GL_READ_WRITE, image->format);
}

void gpu_bind_buffer(const gpu_slot *s, const gpu_buffer *buffer)
{
    if (buffer->id) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, (GLuint)s->unit, buffer->id);
}
