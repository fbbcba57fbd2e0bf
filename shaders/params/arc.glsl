PARAMS(arc_params) {
    float radius;        // R, scene units
    float thickness;     // least thickness of runs of unknown width
    float kappa;         // thickness of a run over its width
    float thin;          // least thickness of a run of known width: 0, or `thickness` if the user has fixed that
    int slices, steps;   // steps a side
    int seed;
    int planes;          // how many planes are in use
    float tolerance;     // of a run, in footprints per pixel of step
    float level;
    float strength;
    int suns;
    int exitant;
    float inverse_steps;
    int before;          // slices of earlier rounds
    int views;           // maps of the surround that a look tries
    float sun_openness;  // share of unseen directions outside the frame that are open to suns; below 0: as of others
    int side;            // of the block of pixels that one of a smaller frame stands for (RECEIVERS)
    int further;         // further views
    int unused;
    vec4 openness[OPENNESS_VECTORS]; // of others, by direction (outside.glsl)
    vec4 walls_low, walls_high; // of its box, upright axes, the eye at the origin
    vec4 upright_from_camera[3]; // rows
    vec4 sun_direction[MAX_SUNS]; // camera space, unit; w half its width, radians
    vec4 sun_light[MAX_SUNS];     // rgb: irradiance over pi of a surface that faces the sun
    vec4 box_low, box_high; // of all surfaces, map axes, the eye at the origin
    vec4 hidden[9];         // radiance coefficients of what lights hidden faces (src/passes/hidden.h)
    vec4 rest[9];           // radiance coefficients of the map without its suns
    vec4 further_rows[3 * MAX_FURTHER]; // from this camera space to the view's
    vec4 further_lens[MAX_FURTHER];     // fx fy cx cy
    vec4 further_size[MAX_FURTHER];     // width, height, first column and row of its picture
    vec4 view_eye[SURROUND_TRIES]; // from a map's eye to the frame's, map axes; w which map
} END_PARAMS(arc_params)
