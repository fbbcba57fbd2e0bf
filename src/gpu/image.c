#include <stdlib.h>

#include "base/mem.h"
#include "gpu/gpu.h"
#include "gpu/internal.h"

static GLenum transfer_format(GLenum format)
{
    switch (format) {
    case GL_R32F:
    case GL_R16F:
        return GL_RED;
    case GL_RG32F:
    case GL_RG16F:
        return GL_RG;
    case GL_RG32UI:
        return GL_RG_INTEGER;
    case GL_RGBA32UI:
        return GL_RGBA_INTEGER;
    default:
        return GL_RGBA;
    }
}

bool gpu_image_make(gpu *g, gpu_image *image, GLenum format, int width, int height, int levels, error *e)
{
    *image = (gpu_image){.format = format, .width = width, .height = height, .levels = levels};
    if (width > g->max_size || height > g->max_size)
        return err_set(e, ERR_GL, NULL, NULL, "an image of %d x %d is larger than this device's limit of %d pixels a side", width,
                       height, g->max_size);
    glCreateTextures(GL_TEXTURE_2D, 1, &image->id);
    glTextureStorage2D(image->id, levels, format, width, height);
    glTextureParameteri(image->id, GL_TEXTURE_MIN_FILTER, levels > 1 ? GL_LINEAR_MIPMAP_LINEAR : GL_NEAREST);
    glTextureParameteri(image->id, GL_TEXTURE_MAG_FILTER, levels > 1 ? GL_LINEAR : GL_NEAREST);
    glTextureParameteri(image->id, GL_TEXTURE_WRAP_S, GL_REPEAT);
    glTextureParameteri(image->id, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    GLenum code = glGetError();
    if (code == GL_NO_ERROR) return true;
    gpu_image_free(image);
    return err_set(e, code == GL_OUT_OF_MEMORY ? ERR_MEMORY : ERR_GL, NULL, NULL,
                   code == GL_OUT_OF_MEMORY
                       ? "the GL device is out of memory: no room for an image of %d x %d pixels; choose another --device or a "
                         "smaller frame"
                       : "the GL device cannot make an image of %d x %d pixels (GL error 0x%04x)",
                   width, height, code);
}

void gpu_image_free(gpu_image *image)
{
    if (image->id) glDeleteTextures(1, &image->id);
    *image = (gpu_image){0};
}

static size_t pixel_bytes(const gpu_image *image)
{
    GLenum f = transfer_format(image->format);
    return (f == GL_RED ? 1 : f == GL_RG || f == GL_RG_INTEGER ? 2 : 4) * sizeof(float);
}

size_t gpu_image_row_bytes(const gpu_image *image) { return (size_t)image->width * pixel_bytes(image); }

void gpu_image_upload(gpu *g, gpu_image *image, int level, const float *pixels)
{
    int w = image->width >> level, h = image->height >> level;
    w = w > 0 ? w : 1, h = h > 0 ? h : 1;
    glTextureSubImage2D(image->id, level, 0, 0, w, h, transfer_format(image->format), GL_FLOAT, pixels);
    g->counts.uploads++;
    g->counts.bytes_up += (long long)((size_t)w * (size_t)h * pixel_bytes(image));
}

void gpu_image_upload_rows(gpu *g, gpu_image *image, int y, int rows, const float *pixels)
{
    glTextureSubImage2D(image->id, 0, 0, y, image->width, rows, transfer_format(image->format), GL_FLOAT, pixels);
    g->counts.uploads++;
    g->counts.bytes_up += (long long)((size_t)rows * gpu_image_row_bytes(image));
}

void gpu_image_download_rows(gpu *g, const gpu_image *image, int y, int rows, float *pixels)
{
    gpu_barrier(g, GL_TEXTURE_UPDATE_BARRIER_BIT);
    glGetTextureSubImage(image->id, 0, 0, y, 0, image->width, rows, 1, transfer_format(image->format), GL_FLOAT,
                         (GLsizei)((size_t)rows * gpu_image_row_bytes(image)), pixels);
    g->counts.read_backs++;
    g->counts.bytes_down += (long long)((size_t)rows * gpu_image_row_bytes(image));
}

void gpu_image_download(gpu *g, const gpu_image *image, float *pixels)
{
    // glGetTextureSubImage counts its buffer in a GLsizei; larger images go in bands.
    size_t row = gpu_image_row_bytes(image);
    int most = (int)(0x40000000u / row);
    for (int y = 0; y < image->height; y += most)
        gpu_image_download_rows(g, image, y, image->height - y < most ? image->height - y : most,
                                pixels + (size_t)y * (row / sizeof *pixels));
}

void gpu_image_clear(gpu_image *image, const float value[4])
{
    const GLuint whole[4] = {(GLuint)value[0], (GLuint)value[1], (GLuint)value[2], (GLuint)value[3]};
    bool integer = image->format == GL_RG32UI || image->format == GL_RGBA32UI;
    glClearTexImage(image->id, 0, transfer_format(image->format), integer ? GL_UNSIGNED_INT : GL_FLOAT,
                    integer ? (const void *)whole : value);
}

GLuint gpu_uniforms_make(size_t size)
{
    GLuint buffer = 0;
    glCreateBuffers(1, &buffer);
    glNamedBufferData(buffer, (GLsizeiptr)size, NULL, GL_DYNAMIC_DRAW);
    return buffer;
}

void gpu_uniforms_set(GLuint buffer, int binding, const void *data, size_t size)
{
    glNamedBufferSubData(buffer, 0, (GLsizeiptr)size, data);
    glBindBufferBase(GL_UNIFORM_BUFFER, (GLuint)binding, buffer);
}

void gpu_uniforms_free(GLuint buffer)
{
    if (buffer) glDeleteBuffers(1, &buffer);
}
