PARAMS(specular_params) {
    int samples;
    int base_albedo; // 1: the albedo is a base colour, which metals reflect
    int unused0, unused1;
} END_PARAMS(specular_params)
