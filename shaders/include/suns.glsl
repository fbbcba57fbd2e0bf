// What a surface gets of a sun that nothing hides.
vec3 sunlight(int i, vec3 N) { return max(dot(N, arc_block.sun_direction[i].xyz), 0.0) * arc_block.sun_light[i].rgb; }
