// Light from the environment by two strategies, weighted by the balance heuristic (Veach and Guibas 1995): directions by cosine,
// and directions by brightness, from the table of src/light/alias_table.h. Both estimate (1 / pi) integral L V cos, and with
// p = cos / pi and q the table's density their weighted terms are
//   by cosine       L p / (p + q)
//   by brightness   L (cos / pi) / (p + q)
// which is the same expression. The white environment needs the first only: q = 0.

struct AliasEntry {
    float keep;
    uint other;
    float density;
};
layout(std430) readonly buffer AliasTable { AliasEntry alias_table[]; };

bool has_alias_table() { return params.alias_table.x > 0; }

float density_of(vec3 direction) {
    if (!has_alias_table()) return 0.0;
    ivec2 size = params.alias_table.xy;
    vec2 uv = map_uv(direction);
    ivec2 at = clamp(ivec2(fract(uv) * vec2(size)), ivec2(0), size - 1);
    return alias_table[at.y * size.x + at.x].density;
}

// A map-space direction by brightness. Only if has_alias_table().
vec3 choose_direction(uvec3 u) {
    uint n = uint(params.alias_table.x * params.alias_table.y), at, rest;
    umulExtended(u.x, n, at, rest);
    if (unit_of(rest) >= alias_table[at].keep) at = alias_table[at].other;
    uint width = uint(params.alias_table.x);
    float azimuth = 2.0 * PI * (0.5 - (float(at % width) + unit_of(u.y)) / float(width));
    float row = PI / float(params.alias_table.y), top = float(at / width) * row;
    // Uniform in solid angle: in the cosine, taken as a difference of angles, which loses nothing at the poles.
    float polar = acos(clamp(mix(cos(top), cos(top + row), unit_of(u.z)), -1.0, 1.0));
    return vec3(sin(polar) * cos(azimuth), sin(polar) * sin(azimuth), cos(polar));
}

// What a direction brings if nothing is in the way.
vec3 light_from(vec3 map_direction, float cosine) {
    if (cosine <= 0.0) return vec3(0.0);
    float p = cosine / PI;
    return radiance_from(map_direction, params.level) * (p / (p + density_of(map_direction)));
}
