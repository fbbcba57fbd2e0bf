// The sample set and the point test of screen-space directional occlusion (Ritschel, Grosch, Seidel 2009),
// shared by the direct pass and the bounce so that both see the same blocked samples.
#include "include/recorded.glsl"

#include "params/ssdo.glsl"

struct Sample {
    vec3 direction; // unit, camera space
    float cosine;   // with the receiver's normal, > 0
    bool blocked;
    ivec2 sender;   // the pixel that blocks
    vec3 surface;   // where its surface meets the ray of the sample
};

// Direction i of N. The cosines are stratified, so directions are uniform in solid angle (README, correction 3). The distance lambda in
// (0, R] has its own permutation of the strata, so that it does not depend on the elevation.
Sample ssdo_sample(int i, vec3 P, mat3 tangents, vec2 noise) {
    float n = float(params.samples);
    Sample s;
    s.cosine = 1.0 - (float(i) + 0.5) / n;
    float sine = sqrt(1.0 - s.cosine * s.cosine);
    float theta = 2.0 * PI * (float(i) * 0.61803399 + noise.x);
    s.direction = tangents * vec3(sine * cos(theta), sine * sin(theta), s.cosine);
    float lambda = params.radius * (1.0 - fract(float(i) * 0.75487767 + noise.y));
    vec3 point = P + lambda * s.direction;
    s.blocked = false;
    s.sender = ivec2(-1);
    s.surface = P;
    Recorded r = recorded_at(point);
    if (!r.exists) return s;
    float behind = behind_recorded(r, point);
    s.blocked = behind > 0.0 && behind <= params.thickness;
    s.sender = r.pixel;
    s.surface = position_at(r.screen, r.depth);
    return s;
}
