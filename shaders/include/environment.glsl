// Looking up the environment map. Map space: u = 0.5 - atan(y, x) / 2pi, v = acos(z) / pi from the top (src/light/environment.h).

uniform sampler2D environment_map;

vec2 map_uv(vec3 direction) {
    float around = fast_atan(abs(direction.y), direction.x) * (direction.y < 0.0 ? -1.0 : 1.0);
    float sine = sqrt(max(0.0, 1.0 - direction.z * direction.z));
    return vec2(0.5 - around * (0.5 / PI), fast_atan(sine, direction.z) * (1.0 / PI));
}

// Level whose texels, at this direction, cover the given solid angle. A texel covers 2 pi^2 sin(theta) / (w h); near
// the poles sin(theta) is bounded by the half texel row that is really there.
float map_level(vec3 direction, float solid_angle) {
    float sin_theta = max(sqrt(max(0.0, 1.0 - direction.z * direction.z)), 0.5 * PI / frame_env.z);
    float texel = 2.0 * PI * PI * sin_theta / (frame_env.y * frame_env.z);
    return clamp(0.5 * log2(solid_angle / texel), 0.0, frame_env.x);
}

// Radiance of a map that is the same everywhere: its first coefficient times Y_00.
vec3 constant_radiance = 0.282094792 * vec3(frame.sh[0].x, frame.sh[0].y, frame.sh[0].z);

// Radiance from a map-space direction.
vec3 radiance_from(vec3 direction, float level) {
    return frame_env.w == 1.0 ? constant_radiance : textureLod(environment_map, map_uv(direction), level).rgb;
}

// Irradiance / pi at a map-space normal from nine radiance coefficients: c1..c5 of Ramamoorthi and Hanrahan (2001).
vec3 sh_irradiance_over_pi(vec4 sh[9], vec3 n) {
    const float c1 = 0.429043, c2 = 0.511664, c3 = 0.743125, c4 = 0.886227, c5 = 0.247708;
    vec3 e = c1 * sh[8].rgb * (n.x * n.x - n.y * n.y) + c3 * sh[6].rgb * n.z * n.z + c4 * sh[0].rgb -
             c5 * sh[6].rgb +
             2.0 * c1 * (sh[4].rgb * n.x * n.y + sh[7].rgb * n.x * n.z + sh[5].rgb * n.y * n.z) +
             2.0 * c2 * (sh[3].rgb * n.x + sh[1].rgb * n.y + sh[2].rgb * n.z);
    return max(e / PI, vec3(0.0));
}
vec3 sh_irradiance_over_pi(vec3 n) { return sh_irradiance_over_pi(frame.sh, n); }
