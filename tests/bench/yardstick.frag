#version 450 core
// The yardstick: a 64-tap box. Its time on a machine is the unit in which times are compared.
layout(binding = 0) uniform sampler2D source;
out float mean;

void main() {
    ivec2 corner = clamp(ivec2(gl_FragCoord.xy) - 4, ivec2(0), textureSize(source, 0) - 8);
    float sum = 0.0;
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 8; x++) sum += texelFetch(source, corner + ivec2(x, y), 0).r;
    mean = sum / 64.0;
}
