PARAMS(hbao_params) {
    float radius; // R, scene units
    float bias;   // radians
    int directions;
    int steps; // a direction
    int seed;
    int unused0, unused1, unused2;
} END_PARAMS(hbao_params)
