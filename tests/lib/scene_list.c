#include "scene_list.h"

#include <string.h>

static void build_wall(scene *s) { scene_wall(s, 60.0, 0.4); }
static void build_corner(scene *s) { scene_corner(s, 0.4); }
static void build_sphere(scene *s) { scene_sphere(s, 1.0, 1.3, 1.5); }
static void build_slit(scene *s) { scene_slit(s, 1.0, 1.0); }
static void build_bar(scene *s) { scene_bar(s, 0.3, 0.2, 0.8, 0.0); }
static void build_patches(scene *s) { scene_patches(s, 1.0, 0.5); }

const listed_scene scene_list[] = {{"clutter", scene_clutter, false}, {"clutter-ortho", scene_clutter, true},
                                   {"wall", build_wall, false},       {"corner", build_corner, false},
                                   {"sphere", build_sphere, false},   {"slit", build_slit, false},
                                   {"bar", build_bar, false},         {"patches", build_patches, false},
                                   {"rocks", scene_rocks, false},     {NULL, NULL, false}};

view listed_view(const listed_scene *l, const scene *s, int width, int height)
{
    view v = l->orthographic ? view_orthographic(width, height, 6.0, 1.0) : view_perspective(width, height, 50.0, 1.0);
    view_scene(&v, s);
    return v;
}

// ---- rocks: octahedra, subdivided onto spheres, bent by a few sines

enum { ROCKS = 5, SUBDIVISIONS = 3, TRIANGLES = 8 << (2 * SUBDIVISIONS) };

typedef struct rock {
    vec3 vertices[TRIANGLES];
    int triangles[TRIANGLES][3];
    int vertex_count, triangle_count;
} rock;

static int middle(rock *r, int a, int b)
{
    vec3 m = v3_normalize(v3_add(r->vertices[a], r->vertices[b]));
    for (int i = 0; i < r->vertex_count; i++)
        if (v3_length(v3_sub(r->vertices[i], m)) < 1e-9) return i;
    r->vertices[r->vertex_count] = m;
    return r->vertex_count++;
}

static void subdivide(rock *r)
{
    static int out[TRIANGLES][3];
    for (int i = 0; i < r->triangle_count; i++) {
        const int *t = r->triangles[i];
        int m[3] = {middle(r, t[0], t[1]), middle(r, t[1], t[2]), middle(r, t[2], t[0])};
        const int four[4][3] = {{t[0], m[0], m[2]}, {m[0], t[1], m[1]}, {m[2], m[1], t[2]}, {m[0], m[1], m[2]}};
        memcpy(out + 4 * i, four, sizeof four);
    }
    r->triangle_count *= 4;
    memcpy(r->triangles, out, sizeof *out * (size_t)r->triangle_count);
}

static void rock_make(rock *r, vec3 at, double size, double phase)
{
    static const int octahedron[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int i = 0; i < 6; i++) {
        double sign = i % 2 ? -1.0 : 1.0;
        r->vertices[i] = i < 2 ? v3(sign, 0, 0) : i < 4 ? v3(0, sign, 0) : v3(0, 0, sign);
    }
    r->vertex_count = 6, r->triangle_count = 8;
    memcpy(r->triangles, octahedron, sizeof octahedron);
    for (int i = 0; i < SUBDIVISIONS; i++) subdivide(r);
    for (int i = 0; i < r->vertex_count; i++) {
        vec3 d = r->vertices[i];
        double bump =
            1.0 + 0.18 * sin(5.0 * d.x + phase) * sin(4.0 * d.y + 2.0 * phase) + 0.1 * sin(9.0 * d.z + 7.0 * d.x + phase);
        r->vertices[i] = v3_add(at, v3_scale(v3(d.x, 0.8 * d.y, 0.6 * d.z), size * bump));
    }
}

void scene_rocks(scene *s)
{
    static rock rocks[ROCKS];
    *s = (scene){.eye = v3(0.5, -6, 3.2), .target = v3(0, 0.2, 0.3), .radius = 1.0};
    scene_add_plane(s, v3(0, 0, 0), v3(0, 0, 1), v3(0.45, 0.4, 0.35));
    for (int i = 0; i < ROCKS; i++) {
        double turn = 2.4 * i;
        rock_make(&rocks[i], v3(0.75 * sqrt(i) * cos(turn), 0.9 * sqrt(i) * sin(turn), 0.25), 0.9 - 0.11 * i, 1.7 * i);
        mesh m = {rocks[i].vertices, rocks[i].vertex_count, (const int(*)[3])rocks[i].triangles, rocks[i].triangle_count};
        scene_add_mesh(s, m, v3(0.5 + 0.08 * i, 0.5, 0.55 - 0.08 * i));
    }
}
