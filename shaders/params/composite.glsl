PARAMS(composite_params) {
    float amount;
    int averaged;   // albedo and emission are stored already multiplied by coverage
    int unused;
    float depthmask; // strength
} END_PARAMS(composite_params)
