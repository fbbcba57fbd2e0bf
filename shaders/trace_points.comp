#version 450 core
// Finds where the pixels' points lie on the mesh. FIND sends a short ray through each point along the line of sight. After it is traced,
// SETTLE moves the point onto the surface that the ray hit. A point whose ray hit nothing stays, with the picture's normal.
#include "include/frame.glsl"
#include "include/trace.glsl"
#ifdef SETTLE
#include "include/triangles.glsl"
#endif

#ifdef FIND
layout(std430) writeonly buffer Rays { Ray rays[]; };
#else
layout(std430) readonly buffer Rays { Ray rays[]; };
layout(std430) readonly buffer Hits { Hit hits[]; };
layout(rgba32f) writeonly uniform image2D point_image; // mesh space; w: how far rays are lifted
layout(rgba32f) writeonly uniform image2D face_image;  // the surface's own normal, towards the eye; w: 1 if the mesh is there
layout(r32f) writeonly uniform image2D occlusion_image;
#endif

const float NEAR = 2e-3;  // of its depth: as far as the mesh may lie off the point; half floats are 5e-4 wrong
const float LIFT = 1e-4;  // of its depth: for points that are not on the mesh

void main() {
    uint i = this_item();
    if (i >= batch_size()) return;
    ivec2 p = pixel_of(i);
    float depth = depth_at(p);
    vec3 P = position_of(p, depth), away = -view_of(P);
#ifdef FIND
    float slack = NEAR * length(P);
    rays[i] = Ray(vec4(to_mesh(P - slack * away) + mesh_offset(), 2.0 * slack), vec4(to_mesh(away), 0.0));
#else
    vec4 point = vec4(to_mesh(P) + mesh_offset(), LIFT * depth), face = vec4(to_mesh(normal_at(p)), 0.0);
    if (hits[i].triangle < HIT_NO_RAY) {
        Triangle t = triangles[hits[i].triangle];
        point.xyz = rays[i].origin.xyz + hits[i].t * rays[i].direction.xyz;
        point.w = lift_of(t, point.xyz);
        face = vec4(face_of(t, rays[i].direction.xyz), 1.0);
    }
    imageStore(point_image, p, point);
    imageStore(face_image, p, face);
    imageStore(occlusion_image, p, vec4(0.0)); // where the sum begins
#endif
}
