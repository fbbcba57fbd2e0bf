// Alternatives to pixel_noise for `make bench-sampling`, by the upper bits of the seed: 16 to 19 where the slice's angle comes from,
// 20 to 23 where the jitters of steps and sectors do.

uint mixed(uint x) { // a hash
    x ^= x >> 16u;
    x *= 0x7feb352du;
    x ^= x >> 15u;
    x *= 0x846ca68bu;
    return x ^ x >> 16u;
}
float unit_of(uint x) { return float(x >> 8u) * (1.0 / 16777216.0); }

// Owen's scrambling of a number's binary digits, by the hash of Laine and Karras 2011.
uint scrambled(uint x, uint seed) {
    x = bitfieldReverse(x);
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16u) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return bitfieldReverse(x);
}
// Sobol's second and third dimension.
uint sobol2(uint i) {
    uint r = 0u;
    for (uint v = 1u << 31u; i != 0u; i >>= 1u, v ^= v >> 1u)
        if ((i & 1u) != 0u) r ^= v;
    return r;
}
uint sobol3(uint i) {
    uint r = 0u, a = 1u << 31u, b = 3u << 30u;
    for (; i != 0u; i >>= 1u) {
        if ((i & 1u) != 0u) r ^= a;
        uint next = b ^ a ^ a >> 2u;
        a = b;
        b = next;
    }
    return r;
}

// Index of a pixel in Z order, the quarters of every square shuffled (Ahmed and Wonka 2020).
uint shuffled_z(uvec2 p, uint seed) {
    uint r = 0u;
    for (int k = 15; k >= 0; k--) {
        uint digit = ((p.x >> k) & 1u) | ((p.y >> k) & 1u) << 1u;
        uint above = mixed((p.x >> k >> 1u) * 0x9e3779b9u ^ mixed((p.y >> k >> 1u) + seed + uint(k)));
        // One of 24 orders of four quarters: which comes first, which second, which third.
        uint order[4] = uint[4](0u, 1u, 2u, 3u), which = above % 24u;
        for (uint left = 4u; left > 1u; left--) {
            uint j = which % left, kept = order[left - 1u];
            which /= left;
            order[left - 1u] = order[j];
            order[j] = kept;
        }
        r |= order[digit] << uint(2 * k);
    }
    return r;
}
uint hilbert(uvec2 p) { // along a curve over 64 x 64 pixels
    uint index = 0u;
    p &= 63u;
    for (uint s = 32u; s > 0u; s /= 2u) {
        uint x = (p.x & s) != 0u ? 1u : 0u, y = (p.y & s) != 0u ? 1u : 0u;
        index += s * s * ((3u * x) ^ y);
        if (y == 0u) p = x == 1u ? uvec2(63u) - p.yx : p.yx;
    }
    return index;
}
float gradient_noise(vec2 p) { return fract(52.9829189 * fract(dot(p, vec2(0.06711056, 0.00583715)))); } // Jimenez 2014

vec3 pixel_noise(ivec2 p, int code) {
    int seed = code & 0xffff, angle = (code >> 16) & 15, jitter = (code >> 20) & 15;
    uvec2 u = uvec2(p) + uint(seed) * 7919u, near = uvec2(p) + uint(seed) * uvec2(37u, 23u);
    vec3 own = chosen_pixel_noise(p, seed), z = own;
    vec2 h = pixel_hash(u);
    uint curve = hilbert(near), order = shuffled_z(uvec2(p), mixed(uint(seed))), scramble = mixed(uint(seed) + 99u);
    switch (angle) {
    case 1: z.x = pixel_hash(u + 12345u).x; break;
    case 2: z.x = gradient_noise(vec2(near)); break;
    case 3: z.x = unit_of(curve * 3242174889u); break;
    case 4: z.x = unit_of(scrambled(bitfieldReverse(order), scramble)); break;
    }
    switch (jitter) {
    case 1: z.yz = h; break;
    case 2: z.yz = vec2(gradient_noise(vec2(near) + 5.588238), gradient_noise(vec2(near) + 2.0 * 5.588238)); break;
    case 3: z.yz = vec2(unit_of(curve * 2447445414u), h.y); break;
    case 4: z.yz = vec2(unit_of(scrambled(sobol2(order), scramble + 1u)), unit_of(scrambled(sobol3(order), scramble + 2u))); break;
    case 5: z.yz = vec2(unit_of(u.x * 3679390609u + u.y * 3152041523u), unit_of(u.x * 2700274806u + u.y * 2313257605u)); break;
    case 6: z.yz = vec2(0.5); break;
    }
    return z;
}
