// One side of a slice: a half plane through the view ray of the receiver, and what of its directions is blocked.
//
// Vectors of the half plane are written (x, y): x along the receiver's tangent, outwards, y along its normal projected into the
// slice. Angles t are measured from V, positive outwards; n is the angle of the projected normal (README, Slices and sectors). Directions are
// named by their share c of the slice's cosine weight, from 0 (the tangent on the far side) to 1 (the tangent on this side):
//     F(t) = (cos n sin^2 t + sin n (t - sin t cos t)) / 2 for t >= 0,   c = (F(t) - F(n - pi/2)) / (cos n + n sin n)

const int CELLS = 8; // of equal angle, into which a slice is divided where each needs a look beyond the frame

struct Side {
    vec3 tangent; // unit, outwards
    vec3 up;      // unit: the receiver's normal projected into the slice
    vec3 lift;    // the normal itself over the length of its projection: dot with it is y of a point, whose pixel may lie beside the
                  // slice's line, such that its height over the tangent plane is kept; so an empty plane stays empty
    float cos_n, sin_n;
    float below;  // -F(n - pi/2)
    float scale;  // 1 / (cos n + n sin n)
    float least;  // a height below this may be rounding of the points' coordinates
    vec2 eye;     // where the eye is, or for an orthographic camera its direction
};

// Nothing below this sine over the tangent plane counts. Rounding and half-float normals cause such sines, and only 1e-5 of the weight
// is there.
const float GRAZING = 0.004;

// The side of a slice towards a direction across V. Also the slice's weight |n_p| (cos n + n sin n) and n.
Side side_of(vec3 V, vec3 outwards, vec3 N, float eye_distance, out float n, out float weight) {
    Side s;
    float up = dot(N, V), sideways = dot(N, outwards), squared = max(up * up + sideways * sideways, 1e-12);
    float inverse_length = inversesqrt(squared);
    s.cos_n = up * inverse_length;
    s.sin_n = sideways * inverse_length;
    n = fast_atan(abs(sideways), up) * (sideways < 0.0 ? -1.0 : 1.0);
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
    float x = w.y * s.cos_n - w.x * s.sin_n, y = w.y * s.sin_n + w.x * s.cos_n, squared = dot(w, w);
    float t = fast_atan(abs(y), x), c = (0.5 * abs(y) * (s.cos_n * y - s.sin_n * x) / max(squared, 1e-30) + 0.5 * s.sin_n * t + s.below) * s.scale;
    return w.y <= s.least || w.y * w.y <= GRAZING * GRAZING * squared ? 1.0 : clamp(c, 0.0, 1.0);
}

vec2 in_slice(Side s, vec3 w) { return vec2(dot(w, s.tangent), dot(w, s.lift)); }

// Unit vector along the view ray through a point, on which the surface hides what is behind it; given 1 over the length of that ray.
vec2 away(Side s, vec2 w, float inverse_distance) { return is_orthographic() ? -s.eye : (w - s.eye) * inverse_distance; }

// c of a signed angle, given with its cosine and sine.
float share_at(Side s, float t, vec2 d) {
    float f = 0.5 * (s.cos_n * d.y * d.y + s.sin_n * (t - d.y * d.x));
    return clamp(((t < 0.0 ? -f : f) + s.below) * s.scale, 0.0, 1.0);
}
float share_at(Side s, float t) { return share_at(s, t, vec2(cos(t), sin(t))); }

// The share at which a cell of the slice ends.
float cell_end(Side s, float n, int i) {
    return i < 0 ? 0.0 : i + 1 == CELLS ? 1.0 : share_at(s, n - 0.5 * PI + float(i + 1) * PI / float(CELLS));
}

// A direction (cos, sin) turned by another.
vec2 turned(vec2 d, vec2 by) { return vec2(d.x * by.x - d.y * by.y, d.x * by.y + d.y * by.x); }
