// Per-pixel numbers that turn a fixed pattern into noise which a filter can remove; tangent frames; normals in 30 bits.

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

// Three numbers per pixel: for the angle of the slices, the places of the steps and the places of the sectors. The first two are
// lattices over the picture: in any small window each of them is stratified, and so are their pairs. A filter over that window
// therefore averages a stratified set. The third number is a hash. The first lattice is Roberts' R2. The second was chosen to go with
// it: the filter of `blur` passes the least of its harmonics, and of the harmonics of both lattices' sums.
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

// A unit vector in 30 bits, exact to a thousandth: enough to tell whether two samples are connected.
uint pack_normal(vec3 n) {
    uvec3 v = uvec3(clamp(n * 511.5 + 512.0, vec3(0.0), vec3(1023.0)));
    return v.x | v.y << 10u | v.z << 20u;
}
vec3 unpack_normal(uint v) { return vec3(uvec3(v, v >> 10u, v >> 20u) & 1023u) * (1.0 / 511.5) - (511.5 / 511.5); }
