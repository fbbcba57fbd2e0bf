// Analytic test scenes and a small ray caster in double precision.
//
// It makes exact G-buffers for tests (scene_picture.h) and is the default intersector of the brute-force truth (truth.h). World
// space is right-handed with z up; lengths are in scene units. Surfaces are two-sided: a normal always faces the origin of the
// ray that found it.
#ifndef SSDO_TESTS_SCENE_H
#define SSDO_TESTS_SCENE_H

#include <stdbool.h>

#include "base/vec.h"

enum { SCENE_MAX_SHAPES = 64 };

typedef enum shape_kind { SHAPE_PLANE, SHAPE_SPHERE, SHAPE_DISC, SHAPE_QUAD, SHAPE_BOX, SHAPE_MESH } shape_kind;

// Triangles of a mesh; vertices and indices are borrowed and must outlive the scene. scene_place moves the vertices in place.
typedef struct mesh {
    vec3 *vertices;
    int vertex_count;
    const int (*triangles)[3];
    int triangle_count;
} mesh;

typedef struct shape {
    shape_kind kind;
    vec3 at;       // plane, disc: a point or the centre; sphere, box: the centre; quad: a corner; mesh: centre of its bounds
    vec3 axis[3];  // plane, disc: unit normal in [0]; quad: edges in [0], [1]; box: three orthogonal half edges
    double radius; // sphere, disc; mesh: radius of its bounds
    mesh mesh;
    vec3 albedo;
} shape;

typedef struct scene {
    shape shapes[SCENE_MAX_SHAPES];
    int shape_count;
    vec3 eye, target, point; // a view that shows the scene well, and a point of interest that the builder names
    double radius;           // an occlusion radius that suits the scene
} scene;

typedef struct hit {
    double t; // in units of the ray direction's length
    vec3 position, normal, albedo;
} hit;

// An intersector: the scene below, or another one (Embree) over the same geometry. Both callbacks look at t in (tmin, tmax); the
// direction need not have unit length. They may be called from several threads at once.
typedef struct tracer {
    bool (*closest)(const void *data, vec3 origin, vec3 direction, double tmin, double tmax, hit *out);
    bool (*blocked)(const void *data, vec3 origin, vec3 direction, double tmin, double tmax);
    const void *data;
} tracer;

tracer scene_tracer(const scene *s); // borrows the scene

// Adding shapes. More than SCENE_MAX_SHAPES is a programming error (assert). Normals need not have unit length.
void scene_add_plane(scene *s, vec3 point, vec3 normal, vec3 albedo);
void scene_add_sphere(scene *s, vec3 centre, double radius, vec3 albedo);
void scene_add_disc(scene *s, vec3 centre, vec3 normal, double radius, vec3 albedo);
void scene_add_quad(scene *s, vec3 corner, vec3 edge_a, vec3 edge_b, vec3 albedo);           // parallelogram
void scene_add_box(scene *s, vec3 centre, vec3 half_size, double turn_degrees, vec3 albedo); // turned about z
void scene_add_mesh(scene *s, mesh m, vec3 albedo);

// The whole scene, its view and its radius: scaled about the origin, then rotated, then moved. Camera poses made before this call
// are moved alike by view_place.
void scene_place(scene *s, double scale, mat3 rotation, vec3 offset);
// Rotation by `degrees` about a unit axis, counter-clockwise looking against the axis.
mat3 rotation_about(vec3 axis, double degrees);

// Canonical scenes. Each sets eye, target, point and radius.

// A plane through (0, distance, 0), tilted by `tilt` degrees from facing an eye at the origin that looks along +y.
void scene_tilted_plane(scene *s, double tilt_degrees, double distance);
// Ground z = 0 and a wall, a huge quad that rises at elevation a from the ground line y = 0 (90: vertical, less: away from the
// viewer, who stands at y < 0). `point` lies on the ground at distance `distance` from the foot.
void scene_wall(scene *s, double elevation_degrees, double distance);
// scene_wall at 90 degrees.
void scene_corner(scene *s, double distance);
// A sphere of radius r whose centre is at height h over the origin of the ground; `point` at ground distance d from there.
void scene_sphere(scene *s, double r, double h, double d);
// A trench along x: ground z = 0 between two blocks of height `depth`, a gap of width w, seen from above. `point` in its middle.
void scene_slit(scene *s, double w, double depth);
// A bar along x with a rectangular cross-section, its underside at height h above the ground, centred over y = 0. `point` at y.
void scene_bar(scene *s, double width, double thickness, double h, double y);
// Two square patches of edge `size` that face each other at distance `gap`: the floor z = 0 and a lid, seen from the side.
// `point` is the floor's centre. The lid is red (.8 .1 .1), the floor grey.
void scene_patches(scene *s, double size, double gap);
// A fixed pseudo-random still life of boxes and spheres on a floor with a wall behind.
void scene_clutter(scene *s);
// A closed white box with the eye inside.
void scene_furnace(scene *s);

#endif
