// The columns of the planes' image, a plane a row (src/passes/arc.c).
const int PLANE_EQUATION = 0; // xyz unit normal, w offset: dot(xyz, x) = w
const int PLANE_U = 1;        // dot(xyz, x) - w: place on the support's first axis, -1 .. 1
const int PLANE_V = 2;
const int PLANE_LIGHT = 3; // rgb: mean of what its pixels send; w how far they may lie off it, negative for uneven ground
const int PLANE_CELLS = 4; // 4 columns: 16 rows of 16 bits over the support: the picture does not show the plane to be absent there
