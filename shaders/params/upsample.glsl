PARAMS(upsample_params) {
    ivec2 small_size;
    float sharpness; // plane distance, in footprints of a small pixel, at which the weight has fallen to exp(-1/2)
    int unused;
    vec4 light[9]; // OPEN_LIGHT: radiance coefficients of what makes colour 0
} END_PARAMS(upsample_params)
