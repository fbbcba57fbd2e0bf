// The mean of values (values.glsl) over a line of pixels, with the weights of bilateral.glsl. `load` gives a pixel's values.

Values mean_along(ivec2 p, float depth, ivec2 step, float sharpness, int radius) {
    Values centre = load(p);
    if (depth == 0.0) return centre;
    Centre c = centre_at(p, depth, sharpness, radius);
    Values sum = values_of(0.0, COLOUR(0.0));
    float total = 1.0;
    for (int i = -radius; i <= radius; i++) {
        ivec2 q = p + i * step;
        if (i == 0) continue;
        float w = tap_weight(c, q, float(i));
        if (w == 0.0) continue;
        sum = add(sum, w, load(q), centre);
        total += w;
    }
    return mean_of(centre, sum, total);
}
