// Directions, tangent frames the per-pixel numbers that turn a fixed pattern into noise a filter can remove, and normals in few bits.

// Two numbers per pixel: the integer hash of Jarzynski and Olano 2020 ("pcg2d").
vec2 pixel_hash(uvec2 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * 1664525u;
    v.y += v.x * 1664525u;
    v ^= v >> 16u;
    v.x += v.y * 1664525u;
    v.y += v.x * 1664525u;
    v ^= v >> 16u;
    return vec2(v >> 8u) * (1.0 / 16777216.0);
}

// Three numbers per pixel, for the angle of slices, the places of steps and those of sectors: two lattices, of which the window of a
// small filter holds a stratified set, pairs included, and a hash. The first is Roberts' R2; the second has beside it the least
// harmonics, of both and of their sums, that pass the filter of `blur`.
vec3 pixel_noise(ivec2 p, int seed) {
    uvec2 u = uvec2(p) + uint(seed) * 7919u;
    uvec2 lattices = u.x * uvec2(3242174889u, 2844675811u) + u.y * uvec2(2447445414u, 4020201488u);
    return vec3(vec2(lattices >> 8u) * (1.0 / 16777216.0), pixel_hash(u).y);
}

// Orthonormal tangent and bitangent of a unit vector without a fixed up vector (Duff et al. 2017, JCGT 6/1).
mat3 tangent_frame(vec3 n) {
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z);
    float b = n.x * n.y * a;
    return mat3(vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3(b, s + n.y * n.y * a, -n.y), n);
}

// A unit vector in 30 bits, to a thousandth: for tests of connection.
uint pack_normal(vec3 n) {
    uvec3 v = uvec3(clamp(n * 511.5 + 512.0, vec3(0.0), vec3(1023.0)));
    return v.x | v.y << 10u | v.z << 20u;
}
vec3 unpack_normal(uint v) { return vec3(uvec3(v, v >> 10u, v >> 20u) & 1023u) * (1.0 / 511.5) - (511.5 / 511.5); }
