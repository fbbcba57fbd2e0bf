// Constants that shaders and C share (src/passes/params.h): plain #defines, so that both languages read this file.

#define GROUP_SIDE 8 // a work group is GROUP_SIDE x GROUP_SIDE invocations

// Binding points of the two uniform blocks. All other units are given to a program when it is linked (src/gpu/slots.c).
#define FRAME_BINDING 0
#define PARAMS_BINDING 1

#define MAX_SUNS 4
#define MAX_FURTHER 24 // further perspective G-buffers
#define GRID_COUNT 6

// Bounds of rays and hits (src/plugin/trace_abi.h).
#define RAY_FAR 1e30
#define HIT_NOTHING 0xffffffffu
#define HIT_NO_RAY 0xfffffffeu

// The columns of the planes' image, a plane a row.
#define PLANE_EQUATION 0 // xyz unit normal, w offset: dot(xyz, x) = w
#define PLANE_U 1        // dot(xyz, x) - w: place on the support's first axis, -1 .. 1
#define PLANE_V 2
#define PLANE_LIGHT 3    // rgb: mean of what its pixels send; w how far they may lie off it, negative for uneven ground
#define PLANE_BELIEF 4   // x: how far the plane is believed in, 0 .. 1; y, z: the sectors that it may block, 16 bits each
#define PLANE_MASK 5     // 4 columns: 16 rows of 16 bits over the support: the picture does not show the plane to be absent there
#define PLANE_COLUMNS 9
#define BELIEVED_PLANE 1.5 // beyond the frame a plane is believed up to here, in half widths of its support

// The lat-long grid of how open the outside is (src/passes/openness.h): columns, a power of 2; rows between the poles; numbers, in
// vectors of four.
#define OPENNESS_COLUMNS 8
#define OPENNESS_ROWS 3
#define OPENNESS_COUNT (2 + OPENNESS_COLUMNS * OPENNESS_ROWS)
#define OPENNESS_VECTORS ((OPENNESS_COUNT + 3) / 4)

// The surround (src/passes/surround.h): texels a side of a map of what is around an eye, and of what that sends; maps that one look tries.
#define SURROUND_SIDE 384
#define SURROUND_COARSE 96
#define SURROUND_TRIES 4
