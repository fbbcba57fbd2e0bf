// What every pass knows of the frame: camera, size, and the surfaces (depth and normal) of camera space.
// Camera space: x right, y down, z forward, the eye at the origin (src/gbuffer/camera.h).

#include "include/constants.glsl"
#include "include/images.glsl"
#include "include/params.glsl"

#ifndef FRAGMENT
layout(local_size_x = GROUP_SIDE, local_size_y = GROUP_SIDE) in;
layout(location = 0) uniform ivec4 tile; // x0 y0 x1 y1, end exclusive
#endif

#include "params/frame.glsl"
// Copies made before main, number by number: llvmpipe reads a uniform inside any control flow once for every lane.
vec4 frame_lens = vec4(frame.lens.x, frame.lens.y, frame.lens.z, frame.lens.w);
vec2 pixel_slope = 1.0 / frame_lens.xy; // of a ray's xy, per pixel
ivec2 frame_size = ivec2(frame.size.x, frame.size.y);
vec4 frame_env = vec4(frame.env.x, frame.env.y, frame.env.z, frame.env.w);
mat3 camera_from_map = mat3(vec3(frame.map_from_camera[0].x, frame.map_from_camera[0].y, frame.map_from_camera[0].z),
                            vec3(frame.map_from_camera[1].x, frame.map_from_camera[1].y, frame.map_from_camera[1].z),
                            vec3(frame.map_from_camera[2].x, frame.map_from_camera[2].y, frame.map_from_camera[2].z));

PICTURE(r32f, depth_image);
PICTURE(rgba32f, normal_image);

const float PI = 3.14159265358979;
const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722); // of linear Rec. 709
const float ULP = 1.1920929e-7; // of 1.0 in float

#ifdef FRAGMENT // what is drawn is the tile
ivec2 this_pixel() { return ivec2(gl_FragCoord.xy); }
#else
ivec2 this_pixel() { return tile.xy + ivec2(gl_GlobalInvocationID.xy); }
bool in_tile(ivec2 p) { return all(lessThan(p, tile.zw)); }
#endif
bool in_frame(ivec2 p) { return all(greaterThanEqual(p, ivec2(0))) && all(lessThan(p, frame_size)); }
// Decided when the shader is compiled (src/passes/pass.c): a rasteriser on the CPU pays for both branches.
#ifdef ORTHOGRAPHIC
bool is_orthographic() { return true; }
#else
bool is_orthographic() { return false; }
#endif

// part / whole, and 1 where they are equal: GL lets a division be wrong by two units in the last place, so that x / x need not be 1.
float ratio(float part, float whole) { return part == whole ? 1.0 : part / whole; }

// Planar depth; 0 where there is no surface or outside the frame.
float depth_at(ivec2 p) { return in_frame(p) ? FETCH(depth_image, p).r : 0.0; }
vec3 normal_at(ivec2 p) { return FETCH(normal_image, p).xyz; }

// Direction of a screen point's ray with z = 1 (perspective).
vec3 ray_at(vec2 screen) { return vec3((screen - frame_lens.zw) * pixel_slope, 1.0); }

vec3 position_at(vec2 screen, float depth) {
    vec3 ray = ray_at(screen);
    return is_orthographic() ? vec3(ray.xy, depth) : ray * depth;
}
vec3 position_of(ivec2 p, float depth) { return position_at(vec2(p) + 0.5, depth); }

// Unit vector from the point to the eye.
vec3 view_of(vec3 point) { return is_orthographic() ? vec3(0.0, 0.0, -1.0) : -normalize(point); }

// Where a point appears on the screen, in pixels. Only for points in front of the eye.
vec2 screen_of(vec3 point) {
    vec2 scaled = is_orthographic() ? point.xy : point.xy / point.z;
    return scaled * frame_lens.xy + frame_lens.zw;
}
bool in_front(vec3 point) { return is_orthographic() || point.z > 0.0; }

// Size of a pixel at a depth, in scene units: a surface facing the eye at that depth covers this much per pixel.
float footprint(float depth) {
    float per_pixel = 1.0 / min(frame_lens.x, frame_lens.y);
    return is_orthographic() ? per_pixel : per_pixel * depth;
}
// The largest error float rounding can put on the coordinates of a point.
float rounding(vec3 point) { return 4.0 * ULP * max(max(abs(point.x), abs(point.y)), abs(point.z)); }

vec3 to_map(vec3 direction) { return direction * camera_from_map; }

// atan(y / x) of y >= 0, any x, to 1e-5 (Abramowitz and Stegun 4.4.47, and its reflections): 0 .. PI.
float fast_atan(float y, float x) {
    float size = abs(x), a = min(y, size) / max(max(y, size), 1e-30), b = a * a;
    float t = a * (0.9998660 + b * (-0.3302995 + b * (0.1801410 + b * (-0.0851330 + b * 0.0208351))));
    t = y > size ? 0.5 * PI - t : t;
    return x < 0.0 ? PI - t : t;
}
