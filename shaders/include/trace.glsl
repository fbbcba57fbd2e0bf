// Shared by the shaders of the ray-traced reference (src/passes/raytrace.c runs them): the list of pixels, which is worked through in
// batches; the rays; their hits; and the light that a ray brings if it hits nothing.
//
// A ray starts at a point of the mesh. The point is lifted off the surface by the largest rounding error there, so that the ray never
// hits the surface it leaves. A direction below the surface has no ray: it is blocked.
// Mesh space has the mesh file's axes and unit, and its origin near the middle of the mesh. Directions are chosen in camera space.
#include "include/rays.glsl"

#include "params/trace.glsl"

layout(std430) readonly buffer Pixels { uint pixels[]; }; // y * width + x of the frame's surfaces

// tile: x the batch's first pixel in the list, y its end. Item i is pixel tile.x + i; batches are padded to whole work groups.
uint this_item() { return gl_WorkGroupID.x * 64u + gl_LocalInvocationIndex; }
uint batch_size() { return uint(tile.y - tile.x); }
ivec2 pixel_of(uint item) {
    int i = int(pixels[uint(tile.x) + item]);
    return ivec2(i % frame_size.x, i / frame_size.x);
}

vec3 to_mesh(vec3 d) {
    return vec3(dot(params.mesh_from_camera[0].xyz, d), dot(params.mesh_from_camera[1].xyz, d),
                dot(params.mesh_from_camera[2].xyz, d));
}
vec3 mesh_offset() { return vec3(params.mesh_from_camera[0].w, params.mesh_from_camera[1].w, params.mesh_from_camera[2].w); }
vec3 to_camera(vec3 d) {
    return params.mesh_from_camera[0].xyz * d.x + params.mesh_from_camera[1].xyz * d.y + params.mesh_from_camera[2].xyz * d.z;
}
vec3 from_map(vec3 d) {
    return frame.map_from_camera[0].xyz * d.x + frame.map_from_camera[1].xyz * d.y + frame.map_from_camera[2].xyz * d.z;
}

float greatest(vec3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

// Towards the side that a ray along `d` comes from.
vec3 face_of(Triangle t, vec3 d) {
    vec3 n = normalize(cross(t.edge1.xyz, t.edge2.xyz));
    return dot(n, d) > 0.0 ? -n : n;
}
vec3 albedo_of(Triangle t) { return vec3(t.corner.w, t.edge1.w, t.edge2.w); }

// Rounding of a triangle's own corners moves its plane too.
float lift_of(Triangle t, vec3 at) {
    vec3 a = t.corner.xyz;
    return 16.0 * ULP *
           max(max(greatest(at), greatest(a)), max(greatest(a + t.edge1.xyz), greatest(a + t.edge2.xyz)));
}

Ray ray_from(vec3 at, vec3 face, float lift, vec3 direction, float reach, bool any) {
    bool above = dot(direction, face) > 0.0;
    return Ray(vec4(at + face * lift, above ? reach : -1.0), vec4(direction, any ? 1.0 : 0.0));
}

// ---- numbers

// Three unrelated numbers from three: the integer hash of Jarzynski and Olano 2020 ("pcg3d").
uvec3 hash3(uvec3 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}
float unit_of(uint u) { return float(u >> 8u) * (1.0 / 16777216.0); }

// The pixel's own numbers number k of this sample.
uvec3 numbers_of(ivec2 p, uint k) {
    return hash3(uvec3(uint(p.x) + (uint(p.y) << 16u), uint(params.sample_index) * 4u + k, uint(params.seed)));
}
// The same for all samples of the pixel: the shift of its sequences.
uvec3 shift_of(ivec2 p, uint k) { return hash3(uvec3(uint(p.x) + (uint(p.y) << 16u), 0x80000000u + k, uint(params.seed))); }

// Point `sample_index` of the additive recurrences R2 and R3 (Roberts 2018), in 32-bit fixed point so that no sample is too many.
uvec2 sequence2() { return uint(params.sample_index) * uvec2(3242174889u, 2447445414u); }
uvec3 sequence3() { return uint(params.sample_index) * uvec3(3518319155u, 2882110345u, 2360945575u); }

// Cosine-weighted, around z.
vec3 cosine_direction(uvec2 u) {
    float r2 = unit_of(u.x), phi = 2.0 * PI * unit_of(u.y), r = sqrt(r2);
    return vec3(r * cos(phi), r * sin(phi), sqrt(max(0.0, 1.0 - r2)));
}
