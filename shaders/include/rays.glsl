// Rays, hits and the mesh they are sent at, as src/plugin/trace_abi.h and src/passes/trace.c lay them out (std430).

struct Ray {
    vec4 origin;    // w: reach; negative: no ray
    vec4 direction; // unit; w: 1 if any hit will do
};
struct Hit {
    float t;
    uint triangle;
};
struct Triangle { // a corner and the edges from it; w: albedo r, g, b
    vec4 corner, edge1, edge2;
};
