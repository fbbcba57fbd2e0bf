PARAMS(tone_params) {
    float scale;
    float contrast;
    int unused0, unused1;
} END_PARAMS(tone_params)
