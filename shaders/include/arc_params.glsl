#define params stored
#include "params/arc.glsl"
#undef params

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
    float openness;
    int views;
    int side;
};
Params params = Params(stored.radius, stored.thickness, stored.kappa, stored.thin, stored.slices, stored.steps, stored.seed,
                       stored.planes, stored.tolerance, stored.level, stored.strength, stored.suns, stored.exitant,
                       stored.inverse_steps, stored.before, stored.openness, stored.views, stored.side);
