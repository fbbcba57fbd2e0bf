// The mean of values (values.glsl) over a line of pixels, with the weights of bilateral.glsl. `load` gives a pixel's values.
// FITTED: the value at the pixel of the straight line that fits them best. Where a surface ends, all taps lie on one side, and a mean
// lags behind what changes towards the edge; a line does not. Its slope is damped, so that few taps do not tilt it, and what it gives
// stays between the taps' values.

const float DAMPING = 0.2; // added to the mean square of the taps' distances, in variances of the Gaussian

Values mean_along(ivec2 p, float depth, ivec2 step, float sharpness, int radius) {
    Values centre = load(p);
    if (depth == 0.0) return centre;
    Centre c = centre_at(p, depth, sharpness, radius);
    Values sum = values_of(0.0, COLOUR(0.0));
    float total = 1.0;
#ifdef FITTED
    Values tilted = sum; // the same sums, weighed by the distance, too
    Range range = Range(centre, centre);
    float first = 0.0, second = 0.0; // moments of the distance
#endif
    for (int i = -radius; i <= radius; i++) {
        ivec2 q = p + i * step;
        if (i == 0) continue;
        float w = tap_weight(c, q, float(i));
        if (w == 0.0) continue;
        Values v = load(q);
        sum = add(sum, w, v, centre);
        total += w;
#ifdef FITTED
        tilted = add(tilted, w * float(i), v, centre);
        range = reach(range, v);
        first += w * float(i), second += w * float(i * i);
#endif
    }
#ifdef FITTED
    float lean = first / (second - DAMPING * 0.5 / c.falloff * total);
    sum = add(sum, -lean, tilted, values_of(0.0, COLOUR(0.0)));
    return within(range, mean_of(centre, sum, total - lean * first));
#else
    return mean_of(centre, sum, total);
#endif
}
