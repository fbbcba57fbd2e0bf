// Exact G-buffers of test scenes: as float arrays, as the program's `gbuffer`, and as EXR files.
//
// The camera convention is gbuffer/camera.h's (x right, y down, z forward; pixel centres at + 0.5). Pixels are single samples at
// their centres unless scene_exr_options asks for filtered edges.
#ifndef SSDO_TESTS_SCENE_PICTURE_H
#define SSDO_TESTS_SCENE_PICTURE_H

#include "base/error.h"
#include "exr/file.h"
#include "gbuffer/gbuffer.h"
#include "scene.h"

// What sees a scene: a size, windows and a posed camera (has_world is set). Change camera.cx, cy for an off-centre principal
// point.
typedef struct view {
    int width, height; // of the data window
    box2 data_window, display_window;
    double pixel_aspect; // width over height of a pixel: fy = fx * pixel_aspect
    camera camera;
} view;

// At the world origin looking along +y with z up; both windows (0, 0) - (width - 1, height - 1). The angle is horizontal.
view view_perspective(int width, int height, double fov_degrees, double pixel_aspect);
view view_orthographic(int width, int height, double width_in_units, double pixel_aspect);
// Moves the eye. `up` is z, or y when looking along z; then the camera is rolled clockwise by roll_degrees about its axis.
void view_look(view *v, vec3 eye, vec3 target, double roll_degrees);
// The scene's own eye and target.
void view_scene(view *v, const scene *s);
// The counterpart of scene_place.
void view_place(view *v, double scale, mat3 rotation, vec3 offset);
// Another data window (a crop, an overscan) over the same display window: the same rays on the pixels both have.
void view_crop(view *v, box2 data_window);

// The world ray through data-window position (x, y): its parameter t is planar depth z.
void view_ray(const view *v, double x, double y, vec3 *origin, vec3 *direction);
// World to data-window position and planar depth, written independently of gbuffer/camera.c. False behind the eye.
bool view_project(const view *v, vec3 world, double *x, double *y, double *z);
// What pixel (x, y) sees; hit.t is planar depth. False where there is no surface.
bool scene_at_pixel(const scene *s, const view *v, int x, int y, hit *out);

// A G-buffer in world space. Where valid is 0 all else is 0.
typedef struct picture {
    int width, height;
    float *position, *normal, *albedo; // 3 a pixel
    float *depth;                      // planar z
    unsigned char *valid;
} picture;

bool scene_picture(const scene *s, const view *v, picture *out, error *e);
void picture_free(picture *p);

// The same as the program's own struct, in camera space, with depth, normal and albedo; coverage, beauty and the rest are NULL.
// extent is the diagonal of the box around the visible surfaces (not the robust size of gbuffer/radius). Free with gbuffer_free.
bool scene_gbuffer(const scene *s, const view *v, gbuffer *out, error *e);

typedef struct scene_exr_options {
    const char
        *convention; // "blender": ViewLayer.Position.X, ..., background Z 1e10; "plain": P.X, N.X, Z, albedo.R, background Z 0
    bool no_position, no_normal, no_depth, no_albedo, no_beauty;
    bool half_position;      // P as half
    bool radial_depth;       // Z is the distance from the eye
    bool camera_space;       // P and N in camera space with y up and z backwards
    double background_depth; // 0 = the convention's
    int edge_samples; // n > 1: N, albedo, beauty and A are means of n x n sub-samples, as Blender writes them; P, Z stay single
    int compression;  // exr_compression_t's value, used by scene_write
} scene_exr_options;

// An EXR file in memory: one part, all channels loaded, no attributes. Beauty is albedo under a fixed hemisphere light, A the
// coverage. Free with scene_file_free, never with exrio_file_close: there is no file behind it.
exrio_file *scene_file(const scene *s, const view *v, const scene_exr_options *options, error *e);
void scene_file_free(exrio_file *f);
// The same written to disk through exr/write.h; the Blender convention carries Blender's marker attribute.
bool scene_write(const scene *s, const view *v, const scene_exr_options *options, const char *path, error *e);

#endif
