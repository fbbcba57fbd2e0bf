// Weights of an edge-aware filter: a Gaussian of a tap's distance, the agreement of the normals, and the distance of the tap from the
// centre's tangent plane in pixel footprints (README, correction 7). Pixels without a surface take no part.
// MIXED_APART: the agreement of a mixed pixel's normal counts for less, as its mean is shorter (src/gbuffer/gbuffer.h, Mixed pixels). Across
// a crease a layer may change by more than a window's mean can follow.

struct Centre {
    vec3 point, normal;
    float scale;   // of the distance from the tangent plane
    float falloff; // -1/2 over the variance of the Gaussian
#ifdef MIXED_APART
    float whole;   // the length of its mean normal
#endif
};

// `sharpness`: plane distance, in footprints, at which the weight has fallen to exp(-1/2).
Centre centre_at(ivec2 p, float depth, float sharpness, int radius) {
    float sigma = 0.5 * float(radius);
    return Centre(position_of(p, depth), normal_at(p), 1.0 / (sharpness * footprint(depth)), -0.5 / (sigma * sigma)
#ifdef MIXED_APART
                  , 1.0 + FETCH(normal_image, p).w
#endif
                  );
}

float tap_weight(Centre c, ivec2 q, float distance) {
    float depth = depth_at(q);
    if (depth == 0.0) return 0.0;
    float off_plane = dot(c.normal, position_of(q, depth) - c.point) * c.scale;
    vec4 n = FETCH(normal_image, q);
    float same_way = max(0.0, dot(c.normal, n.xyz));
#ifdef MIXED_APART
    same_way *= c.whole * (1.0 + n.w);
#endif
    return exp(distance * distance * c.falloff - 0.5 * off_plane * off_plane) * pow(same_way, 8.0);
}
