// How a shader names the pictures that it reads and writes. It names no units: src/gpu/slots.c gives them out when the program is
// linked, and a pass binds by name.
//
//   PICTURE(format, name)   read only; UPICTURE for unsigned integers
//   FETCH(name, p)          its texel at a pixel of the picture
//   FETCH_INSIDE(name, p, zero)  the same, and `zero` where p lies outside the frame
//   LOAD(name, p)           of a picture that the shader also writes, at a pixel of it
//   TARGET(location, type, format, name)  one value for this pixel; PUT stores it. A program that has only these runs in either form:
//                           drawn (FRAGMENT), or dispatched. DRAWN_OR_DISPATCHED(f) calls void f(ivec2 pixel) in both.
//
// With READ_IMAGES pictures are image loads, which a software renderer does faster; without, texel fetches, of which every device has
// enough: GL 4.5 promises 8 images for a program and 16 samplers. An image load outside the picture gives zero; a texel fetch there is
// undefined. llvmpipe before Mesa 21.3 loads for invocations that a branch has switched off too, and ends where their p lies outside.
#ifdef READ_IMAGES
#define PICTURE(format, name) layout(format) readonly uniform image2D name
#define UPICTURE(format, name) layout(format) readonly uniform uimage2D name
#define FETCH(name, p) imageLoad(name, p)
#define FETCH_INSIDE(name, p, zero) imageLoad(name, p)
#define LOAD(name, p) imageLoad(name, p)
#else
#define PICTURE(format, name) uniform sampler2D name
#define UPICTURE(format, name) uniform usampler2D name
#define FETCH(name, p) texelFetch(name, p, 0)
#define FETCH_INSIDE(name, p, zero) (in_frame(p) ? texelFetch(name, p, 0) : zero)
#define LOAD(name, p) imageLoad(name, clamp(p, ivec2(0), imageSize(name) - 1))
#endif

#ifdef FRAGMENT
#define TARGET(place, type, format, name) layout(location = place) out type name
#define PUT(name, p, value) name = value
#define DRAWN_OR_DISPATCHED(f) void main() { f(this_pixel()); }
#else
#define TARGET(place, type, format, name) layout(format) writeonly uniform image2D name
#define PUT(name, p, value) imageStore(name, p, vec4(value))
#define DRAWN_OR_DISPATCHED(f) void main() { ivec2 pixel = this_pixel(); if (in_tile(pixel)) f(pixel); }
#endif
