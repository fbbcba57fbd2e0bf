PARAMS(proxies_params) {
    float radius; // R
    int count;
    float strength; // of the bounce
    int unused;
} END_PARAMS(proxies_params)
