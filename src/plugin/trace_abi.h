// The border between the program (C) and the module ssdo-trace.so (C++), and the form of rays and hits on the GPU
// (shaders/include/trace.glsl, std430).
#ifndef SSDO_PLUGIN_TRACE_ABI_H
#define SSDO_PLUGIN_TRACE_ABI_H

#include <stddef.h>
#include <stdint.h>

// Looks for a triangle at a distance in (0, reach). The direction has unit length. A reach below 0: there is no ray, and its hit
// is TRACE_NO_RAY. any != 0: any triangle will do; else the nearest is wanted.
typedef struct trace_ray {
    float origin[3], reach, direction[3], any;
} trace_ray;

// distance is TRACE_FAR where nothing was hit, and 0 where there was no ray.
typedef struct trace_hit {
    float distance;
    uint32_t triangle;
} trace_hit;

#define TRACE_FAR 1e30f
#define TRACE_MISS 0xffffffffu
#define TRACE_NO_RAY 0xfffffffeu

// Open returns an object that lives until close, or NULL with a sentence in `message`. Vertices are 3 floats, triangles 3 indices
// each; both are copied. Trace may be called from several threads at once.
typedef void *(*trace_open_fn)(const float *vertices, size_t vertex_count, const uint32_t *triangles, size_t triangle_count,
                               int threads, char *message, size_t message_size);
typedef void (*trace_rays_fn)(const void *scene, const trace_ray *rays, trace_hit *hits, size_t count);
typedef void (*trace_close_fn)(void *scene);

#endif
