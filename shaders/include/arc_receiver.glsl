// The pixel whose surroundings a march looks at. What it looks at is always the whole frame.
// RECEIVERS: the pixels are those of a smaller frame (src/gbuffer/half_size.h).
// LONE: the pixels are those of a list.

struct Receiver {
    vec2 origin; // where it appears on the frame that it sees, in pixels
    ivec2 pixel; // of that frame, on its surface
    float depth; // 0: there is no surface
    vec3 N;
};

#ifdef RECEIVERS
PICTURE(r32f, receiver_depth);
PICTURE(rgba32f, receiver_normal);
Receiver receiver_at(ivec2 p) {
    vec4 normal = FETCH(receiver_normal, p);
    int chosen = int(normal.w), side = params.side;
    ivec2 q = side * p + ivec2(chosen % side, chosen % (side * side) / side);
    return Receiver(chosen < side * side ? float(side) * (vec2(p) + 0.5) : vec2(q) + 0.5, q, FETCH(receiver_depth, p).r, normal.xyz);
}
#else
Receiver receiver_at(ivec2 p) { return Receiver(vec2(p) + 0.5, p, depth_at(p), normal_at(p)); }
#endif

// The pixel of this invocation; false if it has none.
#ifdef LONE // tile: x the first of the list's pixels, y their end
layout(std430) readonly buffer Lone { uint lone[]; };
bool receiver_pixel(out ivec2 p) {
    uint item = uint(tile.x) + gl_WorkGroupID.x * (GROUP_SIDE * GROUP_SIDE) + gl_LocalInvocationIndex;
    bool is_listed = item < uint(tile.y);
    uint place = is_listed ? lone[item] : 0u;
    p = ivec2(place & 0xffffu, place >> 16u);
    return is_listed;
}
#else
bool receiver_pixel(out ivec2 p) {
    p = this_pixel();
    return in_tile(p);
}
#endif
