PARAMS(s3ho_params) {
    float radius;    // R, scene units
    float thickness; // scene units; huge = infinite
    int samples;     // N
    int seed;
    vec4 world_from_camera[3]; // rows
    vec4 bands;                // factors of l = 0, 1, 2, 3: the zonal Gaussian low-pass exp(-sigma^2 l (l + 1) / 2)
} END_PARAMS(s3ho_params)
