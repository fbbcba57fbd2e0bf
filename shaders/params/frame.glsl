FRAME_BLOCK {
    vec4 lens;               // fx fy cx cy: focal length and principal point in pixels (orthographic: pixels per scene unit)
    ivec4 size;              // width, height, unused, unused
    vec4 map_from_camera[3]; // rows of the rotation from camera space to the environment map's space
    vec4 env;                // level count - 1, width, height of the map, 1 if it is constant
    vec4 sh[9];              // rgb: plain radiance coefficients in map space
} END_FRAME_BLOCK
