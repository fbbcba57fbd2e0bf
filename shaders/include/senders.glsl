// The light that a surface sends and its albedo in 64 bits: three numbers of 16 bits (7 of exponent, 9 of fraction, no sign), from 2^-62
// to 2^64, and 5 bits for each colour of the albedo, which only a guess is multiplied by (sent_by in include/arc_march.glsl).

const float SENT_SCALE = 18446744073709551616.0; // 2^64: the exponents kept are those of a number this many times smaller

uvec3 pack_light(vec3 L) {
    vec3 small = clamp(L, vec3(0.0), vec3(0.99 * SENT_SCALE)) * (1.0 / SENT_SCALE);
    return (floatBitsToUint(small) + 0x2000u) >> 14u;
}

uvec2 pack_sender(vec3 L, vec3 albedo) {
    uvec3 l = pack_light(L), a = uvec3(clamp(albedo, vec3(0.0), vec3(1.0)) * 31.0 + 0.5);
    return uvec2(l.r | l.g << 16u, l.b | (a.r | a.g << 5u | a.b << 10u) << 16u);
}
vec3 sender_light(uvec2 sender) {
    return uintBitsToFloat(uvec3(sender.x & 0xffffu, sender.x >> 16u, sender.y & 0xffffu) << 14u) * SENT_SCALE;
}
vec3 sender_albedo(uvec2 sender) { return vec3(uvec3(sender.y >> 16u, sender.y >> 21u, sender.y >> 26u) & 31u) * (1.0 / 31.0); }
