// What a surface gets of a sun that nothing hides.
vec3 sunlight(int i, vec3 N) { return max(dot(N, stored.sun_direction[i].xyz), 0.0) * stored.sun_light[i].rgb; }
