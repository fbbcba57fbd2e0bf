PARAMS(depthmask_params) {
    float near;  // depth that becomes 0
    float scale; // 1 / (depth that becomes 1 - near); 0 where all depths are equal
    float sigma; // pixels
    int radius;  // pixels
} END_PARAMS(depthmask_params)
