// G-buffers of one scene as every kind of renderer might store them: the same surfaces in any space, handedness, encoding,
// container and filter. They are made from one master picture in camera space, so that whatever a file looks like, its occlusion
// is the master's.
#ifndef SSDO_TESTS_READING_FILE_H
#define SSDO_TESTS_READING_FILE_H

#include "base/error.h"
#include "gbuffer/depth_code.h"
#include "gbuffer/encoding.h"
#include "scene_picture.h"

// Of a picture of scale 1.
enum { READING_WIDTH = 128, READING_HEIGHT = 96 };

typedef enum reading_scene { SCENE_FLAT, SCENE_ROUND, SCENE_BUMPY, SCENE_FACETS, SCENE_ORTHO, READING_SCENES } reading_scene;
typedef enum reading_filter { FILTER_CLOSEST, FILTER_BOX, FILTER_GAUSS, FILTER_LOBES, READING_FILTERS } reading_filter;
// Camera axes: x right and y up with z backwards or forwards, or y down with z forwards.
typedef enum reading_space { ABSENT, WORLD, EYE_BACK, EYE_FORWARD, EYE_DOWN, OBJECT, READING_SPACES } reading_space;
typedef enum reading_layout { LAYOUT_XYZ, LAYOUT_RGB, LAYOUT_PARTS, READING_LAYOUTS } reading_layout;

// What a compositor may have done to a depth to look at it.
typedef enum reading_change { UNCHANGED, SQUARE_ROOT, LOGARITHM, LESS_NEAR, READING_CHANGES } reading_change;

typedef struct reading_case {
    reading_scene scene;
    int axis;      // 0 1 2: the camera is turned about this axis of the world
    double turn;   // by so many degrees
    bool mirrored; // a left-handed world
    reading_space position, normal;
    normal_encoding encoding;
    int flips;        // bits: components of the normal stored with the other sign
    depth_kind depth; // DEPTH_AUTO: none
    bool negative_depth;
    reading_change change; // of the depth
    reading_filter filter;
    int aside; // closest: sampled so many fifths of a pixel to the right of its centre
    reading_layout layout;
    bool half_normals;
} reading_case;

typedef struct master {
    view view;
    int width, height;
    vec3 *position, *normal; // camera space, y down, FINE x FINE a pixel; position.z 0 where there is no surface
    double radius;
    double near, far; // of its depths, with room
} master;

// The scene in a picture `scale` times as wide and as high.
bool master_make(reading_scene scene, int scale, master *out, error *e);
void master_free(master *m);

// Writes the case to `path`. What it cannot say itself: the field of view or the width, and near and far.
bool reading_write(const master *m, const reading_case *c, const char *path, error *e);

// "flat, turned 45 about y, P world, N camera ..." into buf.
void reading_name(const reading_case *c, char *buf, size_t size);

#endif
