// The mesh of the ray-traced reference, ready to be traced by Embree on the CPU or by a uniform grid on the GPU. In both cases
// rays and hits are in GPU buffers. So all other code is the same, and both back ends get the same rays.
#ifndef SSDO_PASSES_TRACE_H
#define SSDO_PASSES_TRACE_H

#include "base/log.h"
#include "base/vec.h"
#include "gpu/gpu.h"
#include "passes/grid.h"
#include "passes/params.h"
#include "passes/pass.h"
#include "plugin/trace.h"

typedef enum trace_backend { TRACE_AUTO, TRACE_EMBREE, TRACE_GPU } trace_backend; // auto: Embree if its module is there

// Kept for the batch; all zero: nothing is open.
typedef struct trace_scene {
    char *path;  // of the mesh; owned
    vec3 origin; // of mesh space, in the file's: near the middle, so that floats are fine where most of the mesh is
    bool coloured;
    size_t triangle_count;
    gpu_buffer triangles; // corner, edge, edge; w: albedo (shaders/include/rays.glsl)
    trace_cpu *cpu;       // Embree; NULL: the grid
    gpu_buffer offsets, items;
    trace_grid_params grid;
    size_t chunk;    // rays of the grid's next dispatch, such that it takes a few ten milliseconds
    trace_ray *rays; // Embree's copies, owned
    trace_hit *hits;
    size_t capacity;
    gpu_buffer alias_table; // the environment's (light/alias_table.h)
    int table_size[2];
} trace_scene;

// Reads the mesh and builds what traces it, unless that is done. ERR_INPUT for the file, ERR_USAGE when `embree` is asked for and
// missing.
bool trace_scene_open(trace_scene *s, gpu *g, const char *path, trace_backend backend, int threads, log_t *log, error *e);
void trace_scene_close(trace_scene *s);

// Fills hits[0 .. count - 1] with what rays[0 .. count - 1] meet (plugin/trace_abi.h's layouts). Waits for the result.
bool trace_send(trace_scene *s, pass_context *c, const gpu_buffer *rays, gpu_buffer *hits, size_t count, error *e);

// Says that the next rays are longer than the last ones, so that the grid begins with few of them again.
void trace_longer_rays(trace_scene *s);

#endif
