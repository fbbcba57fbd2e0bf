layout(std140, binding = 1) uniform ParamsBlock {
    float radius;        // R, scene units
    float thickness;     // least thickness of runs of unknown width
    float kappa;         // thickness of a run over its width
    float thin;          // least thickness of a run of known width: 0, or where the user has fixed it the same
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
    int unused1;
    vec4 sun_direction[4]; // camera space, unit; w half its width, radians
    vec4 sun_light[4];     // rgb: irradiance over pi of a surface that faces the sun
    vec4 box_low, box_high; // of all surfaces, map axes, the eye at the origin
    vec4 rest[9];           // radiance coefficients of the map without its suns
} stored;

// A copy made before main, as in frame.glsl; number by number, because a block copied whole is read where it is used all the same.
struct Params {
    float radius;
    float thickness;
    float kappa;
    float thin;
    int slices;
    int steps;
    int seed;
    int planes;
    float tolerance;
    float level;
    float strength;
    int suns;
    int exitant;
    float inverse_steps;
    int before;
};
Params params = Params(stored.radius, stored.thickness, stored.kappa, stored.thin, stored.slices, stored.steps, stored.seed,
                       stored.planes, stored.tolerance, stored.level, stored.strength, stored.suns, stored.exitant,
                       stored.inverse_steps, stored.before);
