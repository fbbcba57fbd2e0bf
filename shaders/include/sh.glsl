// Real spherical harmonics up to l = 2, index l * l + l + m, as in src/light/sh.h.
void sh_basis(vec3 d, out float y[9]) {
    y[0] = 0.282094792;
    y[1] = 0.488602512 * d.y;
    y[2] = 0.488602512 * d.z;
    y[3] = 0.488602512 * d.x;
    y[4] = 1.092548431 * d.x * d.y;
    y[5] = 1.092548431 * d.y * d.z;
    y[6] = 0.315391565 * (3.0 * d.z * d.z - 1.0);
    y[7] = 1.092548431 * d.x * d.z;
    y[8] = 0.546274215 * (d.x * d.x - d.y * d.y);
}
