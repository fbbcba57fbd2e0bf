// Real spherical harmonics up to l = 2, with BANDS3 up to 3, index l * l + l + m, as in src/light/sh.h.
#ifdef BANDS3
const int SH_COUNT = 16;
#else
const int SH_COUNT = 9;
#endif

void sh_basis(vec3 d, out float y[SH_COUNT]) {
    y[0] = 0.282094792;
    y[1] = 0.488602512 * d.y;
    y[2] = 0.488602512 * d.z;
    y[3] = 0.488602512 * d.x;
    y[4] = 1.092548431 * d.x * d.y;
    y[5] = 1.092548431 * d.y * d.z;
    y[6] = 0.315391565 * (3.0 * d.z * d.z - 1.0);
    y[7] = 1.092548431 * d.x * d.z;
    y[8] = 0.546274215 * (d.x * d.x - d.y * d.y);
#ifdef BANDS3
    y[9] = 0.590043590 * d.y * (3.0 * d.x * d.x - d.y * d.y);
    y[10] = 2.890611443 * d.x * d.y * d.z;
    y[11] = 0.457045799 * d.y * (5.0 * d.z * d.z - 1.0);
    y[12] = 0.373176333 * d.z * (5.0 * d.z * d.z - 3.0);
    y[13] = 0.457045799 * d.x * (5.0 * d.z * d.z - 1.0);
    y[14] = 1.445305721 * d.z * (d.x * d.x - d.y * d.y);
    y[15] = 0.590043590 * d.x * (d.x * d.x - 3.0 * d.y * d.y);
#endif
}

// The factor of coefficient i's band: x for l = 0, then y, z, w.
float band_of(int i, vec4 bands) { return i == 0 ? bands.x : i < 4 ? bands.y : i < 9 ? bands.z : bands.w; }
