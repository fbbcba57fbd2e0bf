PARAMS(points_params) {
    float radius; // R, scene units
    int samples;
    int seed;
    int unused;
} END_PARAMS(points_params)
