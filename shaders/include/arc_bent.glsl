// Sum of the directions of a slice's blocked sectors, each weighted by its share. The slice is divided into cells of equal angle; the
// middle of a cell stands for all its directions.
vec3 blocked_moment(Side s, vec3 V, vec3 across, float n, uvec2 blocked, float jitter) {
    const int CELLS_OF_BENT = 24;
    vec3 sum = vec3(0.0);
    if (blocked == uvec2(0u)) return sum;
    float from = n - 0.5 * PI, width = PI / float(CELLS_OF_BENT), c = 0.0;
    for (int i = 0; i < CELLS_OF_BENT; i++) {
        float t0 = from + float(i) * width, t = t0 + 0.5 * width, next = i + 1 == CELLS_OF_BENT ? 1.0 : share_at(s, t0 + width);
        sum += sector_share(sectors(c, next, jitter) & blocked) * (cos(t) * V + sin(t) * across);
        c = next;
    }
    return sum;
}
