PARAMS(trace_params) {
    vec4 mesh_from_camera[3]; // rows of the rotation; w: the offset
    float radius;             // of the occlusion
    float level;              // environment level
    float strength;           // of the bounce
    int seed;
    int sample_index;
    int samples; // of all rounds
    int unused0, unused1;
    ivec4 alias_table; // width, height of the environment's table
} END_PARAMS(trace_params)
