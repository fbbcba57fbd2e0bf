// The parameter blocks of the shaders as C structs: shaders/params/*.glsl, read by both languages, so that no member stands
// twice. A block named `arc` is the struct arc_params.
//
// std140 aligns an ivec2 to 8 bytes and a vec4 to 16, C does not: the assertions below hold the two to the same layout.
#ifndef SSDO_PASSES_PARAMS_H
#define SSDO_PASSES_PARAMS_H

#include <stddef.h>

#include "base/vec.h"

#include "../../shaders/include/constants.glsl"

typedef float vec4[4];
typedef int ivec4[4], ivec2[2];

#define PARAMS(name) typedef struct name
#define END_PARAMS(name) name;
#define FRAME_BLOCK typedef struct frame_block
#define END_FRAME_BLOCK frame_block;
#include "../../shaders/params/arc.glsl"
#include "../../shaders/params/blur.glsl"
#include "../../shaders/params/composite.glsl"
#include "../../shaders/params/denoise.glsl"
#include "../../shaders/params/depthmask.glsl"
#include "../../shaders/params/downsample.glsl"
#include "../../shaders/params/frame.glsl"
#include "../../shaders/params/hbao.glsl"
#include "../../shaders/params/points.glsl"
#include "../../shaders/params/proxies.glsl"
#include "../../shaders/params/s3ho.glsl"
#include "../../shaders/params/s3ho_light.glsl"
#include "../../shaders/params/specular.glsl"
#include "../../shaders/params/ssdo.glsl"
#include "../../shaders/params/tile_error.glsl"
#include "../../shaders/params/tone.glsl"
#include "../../shaders/params/trace.glsl"
#include "../../shaders/params/trace_grid.glsl"
#include "../../shaders/params/upsample.glsl"
#include "../../shaders/params/vpl.glsl"
#undef PARAMS
#undef END_PARAMS
#undef FRAME_BLOCK
#undef END_FRAME_BLOCK

// The first vector after the scalars is where the layouts could part.
#define ALIGNED(block, member, to) _Static_assert(offsetof(block, member) % (to) == 0, #block "." #member)
ALIGNED(arc_params, sun_direction, 16);
ALIGNED(blur_params, step, 8);
ALIGNED(frame_block, sh, 16);
ALIGNED(s3ho_params, world_from_camera, 16);
ALIGNED(s3ho_light_params, light, 16);
ALIGNED(trace_params, alias_table, 16);
ALIGNED(trace_grid_params, size, 16);
ALIGNED(upsample_params, light, 16);
#undef ALIGNED

// A block is read in whole vectors. 14 blocks of 16 KiB are what GL 4.5 promises.
#define WHOLE(block) _Static_assert(sizeof(block) % 16 == 0 && sizeof(block) <= 16384, #block)
WHOLE(arc_params);
WHOLE(blur_params);
WHOLE(composite_params);
WHOLE(denoise_params);
WHOLE(depthmask_params);
WHOLE(downsample_params);
WHOLE(frame_block);
WHOLE(hbao_params);
WHOLE(tone_params);
WHOLE(points_params);
WHOLE(proxies_params);
WHOLE(s3ho_params);
WHOLE(s3ho_light_params);
WHOLE(specular_params);
WHOLE(ssdo_params);
WHOLE(tile_error_params);
WHOLE(trace_params);
WHOLE(trace_grid_params);
WHOLE(upsample_params);
WHOLE(vpl_params);
#undef WHOLE

enum { PARAMS_LARGEST = 4096 }; // bytes that a pass has room for
_Static_assert(sizeof(arc_params) <= PARAMS_LARGEST && sizeof(s3ho_light_params) <= PARAMS_LARGEST &&
                   sizeof(trace_grid_params) <= PARAMS_LARGEST,
               "parameter blocks are larger than their buffer");

// A vector of a block, or a texel, from three numbers and a fourth.
static inline void params_put(float to[4], vec3 a, double w)
{
    to[0] = (float)a.x, to[1] = (float)a.y, to[2] = (float)a.z, to[3] = (float)w;
}

#endif
