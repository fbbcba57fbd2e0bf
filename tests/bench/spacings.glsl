// Spacings of steps for `make bench-sampling`, by the highest bits of the seed.
float step_distance(int i, float jitter, float limit) {
    float u = (float(i) + jitter) * params.inverse_steps, least = float(i + 1);
    switch ((params.seed >> 24) & 15) {
    case 1: return max(limit * u * sqrt(u), least);
    case 2: return max(limit * u * u, least);
    case 3: return max(limit * u * u * sqrt(u), least);
    case 4: return max(limit * u * u * u, least);
    case 5: return max(limit * u * u, 1.0);
    }
    return chosen_step_distance(i, jitter, limit);
}
