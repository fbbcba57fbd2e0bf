// One side of a slice: a half plane through the view ray of the receiver, and what of its directions is blocked.
//
// Vectors of the half plane are written (x, y): x along the receiver's tangent, outwards, y along its normal projected into the
// slice. Angles t are measured from V, positive outwards; n is the angle of the projected normal (THEORY.md 2). Directions are
// named by their share c of the slice's cosine weight, from 0 (the tangent on the far side) to 1 (the tangent on this side):
//     F(t) = (cos n sin^2 t + sin n (t - sin t cos t)) / 2 for t >= 0,   c = (F(t) - F(n - pi/2)) / (cos n + n sin n)

struct Side {
    vec3 tangent; // unit, outwards
    vec3 up;      // unit: the receiver's normal projected into the slice
    vec3 lift;    // the normal itself over the length of its projection: dot with it is y of a point, whose pixel may lie beside the
                  // slice's line, such that its height over the tangent plane is kept; so an empty plane stays empty
    float cos_n, sin_n;
    float below;  // -F(n - pi/2)
    float scale;  // 1 / (cos n + n sin n)
    float least;  // height below which it is the rounding of the points' coordinates
    vec2 eye;     // where the eye is, or for an orthographic camera its direction
};

// acos to 7e-5 (Abramowitz and Stegun 4.4.45).
float fast_acos(float x) {
    float a = abs(x);
    float r = sqrt(1.0 - a) * (1.5707288 + a * (-0.2121144 + a * (0.0742610 - 0.0187293 * a)));
    return x < 0.0 ? PI - r : r;
}

// Below this sine over the tangent plane nothing counts: rounding and half-float normals live there, and 1e-5 of the weight.
const float GRAZING = 0.004;

// The side of a slice towards a direction across V. Also the slice's weight |n_p| (cos n + n sin n) and n.
Side side_of(vec3 V, vec3 outwards, vec3 N, float eye_distance, out float n, out float weight) {
    Side s;
    float up = dot(N, V), sideways = dot(N, outwards), squared = max(up * up + sideways * sideways, 1e-12);
    float inverse_length = inversesqrt(squared);
    n = atan(sideways, up);
    s.cos_n = up * inverse_length;
    s.sin_n = sideways * inverse_length;
    weight = squared * inverse_length * (s.cos_n + n * s.sin_n);
    s.tangent = s.cos_n * outwards - s.sin_n * V;
    s.up = s.cos_n * V + s.sin_n * outwards;
    s.lift = N * inverse_length;
    s.below = 0.5 * (s.cos_n + (n - 0.5 * PI) * s.sin_n);
    s.scale = 1.0 / (s.cos_n + n * s.sin_n);
    s.least = 8.0 * ULP * eye_distance * inverse_length;
    s.eye = vec2(-s.sin_n, s.cos_n) * (is_orthographic() ? 1.0 : eye_distance);
    return s;
}

// The other side of the same slice.
Side opposite(Side s, float n) {
    s.tangent = -s.tangent;
    s.sin_n = -s.sin_n;
    s.below = 0.5 * (s.cos_n - (n + 0.5 * PI) * s.sin_n);
    s.eye.x = -s.eye.x;
    return s;
}

// c of the direction to a point; 1 at and below the tangent plane.
float share(Side s, vec2 w) {
    float l = inversesqrt(max(dot(w, w), 1e-30));
    float ct = clamp((w.y * s.cos_n - w.x * s.sin_n) * l, -1.0, 1.0), st = max((w.y * s.sin_n + w.x * s.cos_n) * l, 0.0);
    float t = fast_acos(ct);
    float c = (0.5 * (s.cos_n * st * st + s.sin_n * (t - st * ct)) + s.below) * s.scale;
    return w.y <= max(GRAZING / l, s.least) ? 1.0 : clamp(c, 0.0, 1.0);
}

vec2 in_slice(Side s, vec3 w) { return vec2(dot(w, s.tangent), dot(w, s.lift)); }

// Unit vector from the eye through a point, on which the surface hides what is behind it.
vec2 away(Side s, vec2 w) { return is_orthographic() ? -s.eye : normalize(w - s.eye); }

// c of a signed angle.
float share_at(Side s, float t) {
    float st = sin(t), f = 0.5 * (s.cos_n * st * st + s.sin_n * (t - st * cos(t)));
    return clamp(((t < 0.0 ? -f : f) + s.below) * s.scale, 0.0, 1.0);
}
