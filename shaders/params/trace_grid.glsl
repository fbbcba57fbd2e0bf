PARAMS(trace_grid_params) {
    vec4 low[GRID_COUNT];   // corner
    vec4 cell[GRID_COUNT];  // size of a cell
    ivec4 size[GRID_COUNT]; // in cells; w: its first offset. 0: no grid
} END_PARAMS(trace_grid_params)
