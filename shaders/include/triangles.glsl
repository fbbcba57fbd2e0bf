// The mesh that rays are sent at.
#include "include/rays.glsl"

layout(std430) readonly buffer Triangles { Triangle triangles[]; };
