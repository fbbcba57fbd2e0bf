PARAMS(downsample_params) {
    ivec2 whole_size;
    float near; // footprints of a pixel of the whole frame between a pixel and the tangent plane of the small one
    float like; // cosine between their normals
} END_PARAMS(downsample_params)
