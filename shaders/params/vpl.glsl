PARAMS(vpl_params) {
    float strength;
    int count;
    int unused0, unused1;
} END_PARAMS(vpl_params)
