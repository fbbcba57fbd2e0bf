#include "gpu/gpu.h"

bool gpu_buffer_make(gpu *g, gpu_buffer *buffer, const void *data, size_t size, const char *what, error *e)
{
    GLint64 most = 0;
    *buffer = (gpu_buffer){.size = size};
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
    if (size > (size_t)most)
        return err_set(e, ERR_GL, NULL, NULL, "%s needs %zu MB, and this device's buffers hold at most %zu MB", what, size >> 20,
                       (size_t)most >> 20);
    glCreateBuffers(1, &buffer->id);
    glNamedBufferData(buffer->id, (GLsizeiptr)(size ? size : 4), data, GL_DYNAMIC_DRAW);
    if (data) g->counts.uploads++, g->counts.bytes_up += (long long)size;
    GLenum code = glGetError();
    if (code == GL_NO_ERROR) gpu_label(g, GL_BUFFER, buffer->id, what);
    if (code == GL_NO_ERROR) return true;
    gpu_buffer_free(buffer);
    return err_set(e, code == GL_OUT_OF_MEMORY ? ERR_MEMORY : ERR_GL, NULL, NULL,
                   "the GL device cannot hold %s of %zu MB (GL error 0x%04x)", what, size >> 20, code);
}

void gpu_buffer_free(gpu_buffer *buffer)
{
    if (buffer->id) glDeleteBuffers(1, &buffer->id);
    *buffer = (gpu_buffer){0};
}

void gpu_buffer_write(gpu *g, gpu_buffer *buffer, const void *data, size_t size)
{
    g->counts.uploads++, g->counts.bytes_up += (long long)size;
    glNamedBufferSubData(buffer->id, 0, (GLsizeiptr)size, data);
}

void gpu_buffer_read(gpu *g, const gpu_buffer *buffer, void *data, size_t size)
{
    g->counts.read_backs++, g->counts.bytes_down += (long long)size;
    gpu_barrier(g, GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(buffer->id, 0, (GLsizeiptr)size, data);
}
