PARAMS(tile_error_params) {
    int size; // of a tile, pixels
    int columns;
    int unused0, unused1;
} END_PARAMS(tile_error_params)
