#version 450 core
// The tracer: rays against the mesh in a uniform grid, walked cell by cell (Amanatides and Woo 1987). Ray tile.x + i is item i.
// There are several grids (src/passes/grid.h), one after the other; each looks no further than those before have found.
#include "include/frame.glsl"
#include "include/rays.glsl"
#include "include/triangles.glsl"
#include "params/trace_grid.glsl"

struct Grid {
    vec4 low;   // corner
    vec4 cell;  // size of a cell
    ivec4 size; // in cells; w: its first offset. 0: no grid
};

layout(std430) readonly buffer Rays { Ray rays[]; };
layout(std430) writeonly buffer Hits { Hit hits[]; };
layout(std430) readonly buffer Offsets { uint offsets[]; };
layout(std430) readonly buffer Items { uint items[]; };

// Edges are a little wide, so that no ray slips through between two triangles.
const float EDGE = 1e-6;

// Moeller and Trumbore 1997. The distance, or RAY_FAR.
float distance_to(Triangle t, vec3 origin, vec3 direction) {
    vec3 p = cross(direction, t.edge2.xyz), s = origin - t.corner.xyz;
    float det = dot(t.edge1.xyz, p);
    if (det == 0.0) return RAY_FAR;
    float u = dot(s, p) / det;
    vec3 q = cross(s, t.edge1.xyz);
    float v = dot(direction, q) / det, at = dot(t.edge2.xyz, q) / det;
    return u >= -EDGE && v >= -EDGE && u + v <= 1.0 + EDGE && at > 0.0 ? at : RAY_FAR;
}

void search_cell(uint cell, Ray r, inout Hit best) {
    for (uint k = offsets[cell], end = offsets[cell + 1u]; k < end; k++) {
        float t = distance_to(triangles[items[k]], r.origin.xyz, r.direction.xyz);
        if (t < best.t) best = Hit(t, items[k]);
    }
}

void search_grid(Grid g, Ray r, inout Hit best) {
    vec3 d = r.direction.xyz, origin = r.origin.xyz;
    vec3 safe = mix(d, vec3(1e-12), lessThan(abs(d), vec3(1e-12)));
    vec3 t0 = (g.low.xyz - origin) / safe, t1 = (g.low.xyz + g.cell.xyz * vec3(g.size.xyz) - origin) / safe;
    vec3 near = min(t0, t1), far = max(t0, t1);
    float enter = max(max(near.x, near.y), max(near.z, 0.0)), leave = min(far.x, min(far.y, far.z));
    if (enter > leave || enter > best.t) return;
    ivec3 at = clamp(ivec3(floor((origin + enter * d - g.low.xyz) / g.cell.xyz)), ivec3(0), g.size.xyz - 1);
    ivec3 way = mix(ivec3(-1), ivec3(1), greaterThan(safe, vec3(0.0)));
    vec3 stride = abs(g.cell.xyz / safe);
    vec3 next = (g.low.xyz + g.cell.xyz * vec3(at + max(way, ivec3(0))) - origin) / safe; // where each axis leaves the cell
    bool wants_any = r.direction.w != 0.0;
    int most = g.size.x + g.size.y + g.size.z; // steps, whatever rounding does
    for (int i = 0; i < most; i++) {
        search_cell(uint(g.size.w + (at.z * g.size.y + at.y) * g.size.x + at.x), r, best);
        float out_at = min(next.x, min(next.y, next.z));
        if (best.t <= out_at || (wants_any && best.triangle != HIT_NOTHING)) return;
        bool x = next.x == out_at, y = !x && next.y == out_at;
        bvec3 axis = bvec3(x, y, !x && !y);
        at += mix(ivec3(0), way, axis);
        next += mix(vec3(0.0), stride, axis);
        if (any(lessThan(at, ivec3(0))) || any(greaterThanEqual(at, g.size.xyz))) return;
    }
}

void main() {
    uint i = uint(tile.x) + gl_WorkGroupID.x * 64u + gl_LocalInvocationIndex;
    if (i >= uint(tile.y)) return;
    Ray r = rays[i];
    if (r.origin.w < 0.0) {
        hits[i] = Hit(0.0, HIT_NO_RAY);
        return;
    }
    Hit best = Hit(r.origin.w, HIT_NOTHING);
    bool wants_any = r.direction.w != 0.0;
    for (int k = 0; k < GRID_COUNT; k++) {
        Grid g = Grid(params.low[k], params.cell[k], params.size[k]);
        if (g.size.x > 0 && !(wants_any && best.triangle != HIT_NOTHING)) search_grid(g, r, best);
    }
    if (best.triangle == HIT_NOTHING) best.t = RAY_FAR;
    hits[i] = best;
}
