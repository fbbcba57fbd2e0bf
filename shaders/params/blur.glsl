PARAMS(blur_params) {
    ivec2 step; // (1,0) or (0,1)
    int radius; // pixels
    float sharpness; // plane distance, in footprints, at which the weight has fallen to exp(-1/2)
} END_PARAMS(blur_params)
