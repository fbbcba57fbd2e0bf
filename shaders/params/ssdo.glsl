PARAMS(ssdo_params) {
    float radius;    // R, scene units
    float thickness; // scene units; huge = infinite
    int samples;     // N directions, one point each
    int seed;
    float level;     // environment level; negative: by solid angle
    float strength;  // of the bounce
    int exitant;     // senders hold exitant radiance (a beauty), not light before albedo
    int unused;
} END_PARAMS(ssdo_params)
