#version 450 core
// Fills the layers of pixels that a surface covers in part but that have no position, because the pixel's centre missed the surface. The
// values come from the nearest pixel with a surface; among equally near ones, from the one with the most similar normal
// (src/gbuffer/README.md, Coverage).
#include "include/frame.glsl"

PICTURE(r32f, coverage_image);
// Pixels without a surface are written, pixels with one are read. So no pixel is both read and written.
#ifdef OCCLUSION
layout(r32f) uniform image2D occlusion_image;
#endif
#ifdef VISIBILITY
layout(r32f) uniform image2D visibility_image;
#endif
#ifdef RADIANCE
layout(rgba32f) uniform image2D radiance_image;
#endif
#ifdef INDIRECT
layout(rgba32f) uniform image2D indirect_image;
#endif
#ifdef BENT
layout(rgba32f) uniform image2D bent_image;
#endif
#ifdef SH
layout(rgba32f) uniform image2D sh0_image;
layout(rgba32f) uniform image2D sh1_image;
layout(rgba32f) uniform image2D sh2_image;
#ifdef BANDS3
layout(rgba32f) uniform image2D sh3_image;
layout(rgba32f) uniform image2D sh4_image;
#endif
#endif

const int REACH = 2;

void main() {
    ivec2 p = this_pixel();
    if (!in_tile(p) || depth_at(p) != 0.0 || FETCH(coverage_image, p).r <= 0.0) return;
    vec3 N = normal_at(p);
    float best = 1e9;
    ivec2 from = p;
    for (int y = -REACH; y <= REACH; y++)
        for (int x = -REACH; x <= REACH; x++) {
            ivec2 q = p + ivec2(x, y);
            if (depth_at(q) == 0.0) continue;
            // Distance decides first: the nearest surface is the foreground. The normal decides only among nearly equal distances.
            float cost = float(x * x + y * y) + 0.9 * (1.0 - dot(N, normal_at(q)));
            if (cost < best) {
                best = cost;
                from = q;
            }
        }
    if (from == p) return;
#ifdef OCCLUSION
    imageStore(occlusion_image, p, LOAD(occlusion_image, from));
#endif
#ifdef VISIBILITY
    imageStore(visibility_image, p, LOAD(visibility_image, from));
#endif
#ifdef RADIANCE
    imageStore(radiance_image, p, LOAD(radiance_image, from));
#endif
#ifdef INDIRECT
    imageStore(indirect_image, p, LOAD(indirect_image, from));
#endif
#ifdef BENT
    imageStore(bent_image, p, LOAD(bent_image, from));
#endif
#ifdef SH
    imageStore(sh0_image, p, LOAD(sh0_image, from));
    imageStore(sh1_image, p, LOAD(sh1_image, from));
    imageStore(sh2_image, p, LOAD(sh2_image, from));
#ifdef BANDS3
    imageStore(sh3_image, p, LOAD(sh3_image, from));
    imageStore(sh4_image, p, LOAD(sh4_image, from));
#endif
#endif
}
