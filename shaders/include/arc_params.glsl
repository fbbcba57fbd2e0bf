#define params arc_block
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
    int views;
    float sun_openness;
    int side;
    int further;
};
Params params = Params(arc_block.radius, arc_block.thickness, arc_block.kappa, arc_block.thin, arc_block.slices, arc_block.steps, arc_block.seed,
                       arc_block.planes, arc_block.tolerance, arc_block.level, arc_block.strength, arc_block.suns, arc_block.exitant,
                       arc_block.inverse_steps, arc_block.before, arc_block.views, arc_block.sun_openness, arc_block.side,
                       arc_block.further);
