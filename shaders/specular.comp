#version 450 core
// Specular light of the environment, not occluded: GGX (Walter et al. 2007) by importance sampling, where the density of a sample
// gives the mip level of its lookup (Colbert and Krivanek 2007, GPU Gems 3).
//   half vectors with pdf D(h) (n.h); L weighted by F G (v.h) / ((n.v)(n.h)); level from Omega_s = 1 / (samples * pdf(l)).
// alpha = roughness^2, F0 = lerp(0.04, base colour, metallic). Also writes kD = (1 - F)(1 - metallic), with F at the angle between N and V.
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/environment.glsl"

PICTURE(rg32f, material_image);   // roughness, metallic
PICTURE(rgba32f, albedo_image);
layout(rgba32f) writeonly uniform image2D specular_image; // rgb
layout(rgba32f) writeonly uniform image2D diffuse_share_image; // kD

#include "params/specular.glsl"

float geometry_smith(float nv, float nl, float alpha) {
    float a2 = alpha * alpha;
    float v = nl * sqrt(nv * nv * (1.0 - a2) + a2), l = nv * sqrt(nl * nl * (1.0 - a2) + a2);
    return v + l > 0.0 ? 2.0 * nl * nv / (v + l) : 0.0;
}
float distribution_ggx(float nh, float alpha) {
    float a2 = alpha * alpha, d = nh * nh * (a2 - 1.0) + 1.0;
    return a2 / max(PI * d * d, 1e-20);
}
vec3 fresnel(vec3 f0, float cosine) { return f0 + (1.0 - f0) * pow(1.0 - clamp(cosine, 0.0, 1.0), 5.0); }

// The i-th point of Hammersley's set.
vec2 hammersley(int i, int n) { return vec2((float(i) + 0.5) / float(n), float(bitfieldReverse(uint(i))) * 2.3283064e-10); }

void main() {
    ivec2 p = this_pixel();
    if (!in_tile(p)) return;
    float depth = depth_at(p);
    if (depth == 0.0) {
        imageStore(specular_image, p, vec4(0.0));
        imageStore(diffuse_share_image, p, vec4(1.0));
        return;
    }
    vec2 material = clamp(FETCH(material_image, p).rg, 0.0, 1.0);
    vec3 base = params.base_albedo == 1 ? FETCH(albedo_image, p).rgb : vec3(0.0);
    vec3 f0 = mix(vec3(0.04), base, material.y);
    float alpha = max(material.x * material.x, 1e-3);
    vec3 P = position_of(p, depth), N = normal_at(p), V = view_of(P);
    float nv = max(dot(N, V), 1e-3);
    mat3 tangents = tangent_frame(N);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < params.samples; i++) {
        vec2 u = hammersley(i, params.samples);
        float nh = sqrt((1.0 - u.y) / (1.0 + (alpha * alpha - 1.0) * u.y));
        float sine = sqrt(max(0.0, 1.0 - nh * nh)), turn = 2.0 * PI * u.x;
        vec3 H = tangents * vec3(sine * cos(turn), sine * sin(turn), nh);
        float vh = dot(V, H);
        vec3 L = 2.0 * vh * H - V;
        float nl = dot(N, L);
        if (nl <= 0.0 || vh <= 0.0) continue;
        float pdf = distribution_ggx(nh, alpha) * nh / (4.0 * vh);
        vec3 direction = to_map(L);
        vec3 radiance = radiance_from(direction, map_level(direction, 1.0 / (float(params.samples) * max(pdf, 1e-6))));
        sum += radiance * fresnel(f0, vh) * geometry_smith(nv, nl, alpha) * vh / (nv * nh);
    }
    imageStore(specular_image, p, vec4(sum / float(params.samples), 0.0));
    imageStore(diffuse_share_image, p, vec4((1.0 - fresnel(f0, nv)) * (1.0 - material.y), 0.0));
}
