// The Embree module, opened on demand (plugin/module.h): triangles on the CPU that rays can be sent at.
#ifndef SSDO_PLUGIN_TRACE_H
#define SSDO_PLUGIN_TRACE_H

#include <stdbool.h>

#include "base/error.h"
#include "plugin/trace_abi.h"

typedef struct trace_cpu trace_cpu;

// 3 floats a vertex, 3 indices a triangle, both copied. `threads` build and trace. ERR_USAGE names the module where it is
// missing, for then another --trace is the remedy.
bool trace_cpu_open(const float *vertices, size_t vertex_count, const uint32_t *triangles, size_t triangle_count, int threads,
                    trace_cpu **out, error *e);
// hits[i] answers rays[i].
void trace_cpu_rays(const trace_cpu *t, const trace_ray *rays, trace_hit *hits, size_t count);
void trace_cpu_close(trace_cpu *t);

#endif
