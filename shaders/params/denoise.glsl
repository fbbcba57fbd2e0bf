PARAMS(denoise_params) {
    int radius; // pixels
    float sharpness; // as of blur
    int unused0, unused1;
} END_PARAMS(denoise_params)
