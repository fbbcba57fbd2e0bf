layout(std140, binding = 1) uniform Params {
    float radius;        // R, scene units
    float thickness;     // of runs of unknown width; where `fixed_thickness`, of everything
    float kappa;         // thickness of a run over its width
    int fixed_thickness;
    int slices, steps;   // steps a side
    int seed;
    int planes;          // how many planes are in use
    float tolerance;     // of a run, in footprints per pixel of step
    float level;
    float strength;
    int suns;
    int exitant, unused0, unused1, unused2;
    vec4 sun_direction[4]; // camera space, unit
    vec4 sun_light[4];     // rgb: irradiance over pi of a surface that faces the sun
} params;

const float UNLIMITED = 1e12; // radii from here on mean: no limit
