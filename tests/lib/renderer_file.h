// Small files in the conventions of renderers, written from facts about their headers and not from the program's own table
// (src/gbuffer/conventions.c), which is what they test. Each fact's source is named in renderer_facts.c.
#ifndef SSDO_TESTS_RENDERER_FILE_H
#define SSDO_TESTS_RENDERER_FILE_H

#include "exr/write.h"
#include "scene_picture.h"

// The axes a renderer's vectors are in. Worlds: z up (Blender's, the scene's own), y up, Unreal's left-handed z up in
// centimetres.
typedef enum world_axes { WORLD_Z_UP, WORLD_Y_UP, WORLD_UNREAL } world_axes;
typedef enum vector_space { IN_WORLD, IN_CAMERA_BACK, IN_CAMERA_FORWARD } vector_space; // y up, z backwards or forwards
typedef enum file_layout { ONE_PART, PART_PER_LAYER, FILE_PER_LAYER } file_layout;

enum { FACT_ATTRIBUTES = 10, FACT_FILES = 8 };

// What the camera's attributes are computed from: the pose and lens in the renderer's own world.
typedef struct fact_camera {
    vec3 right, up, forward, eye;
    double fov_degrees;  // horizontal
    double cot_x, cot_y; // cotangents of the half angles
} fact_camera;

typedef struct renderer_fact {
    const char *expected; // the row that has to be recognised
    const char *source;   // of the facts
    const char *position; // "layer:XYZ", "layer:rgb" ...: components follow the colon; no layer: "Z"; NULL: not in the file
    const char *normal, *depth, *albedo, *beauty;
    world_axes world;
    vector_space position_space, normal_space;
    bool radial, unorm_normals, half_normals, half_colours, tiled, cropped;
    double background_depth, background_position;
    file_layout layout;
    int (*attributes)(const fact_camera *, exrio_out_attr *, char (*texts)[32]); // returns their number
} renderer_fact;

extern const renderer_fact renderer_facts[];
extern const int renderer_fact_count;

// The view's camera in the fact's world.
fact_camera renderer_camera(const renderer_fact *fact, const view *v);

// Writes the scene as the fact says into `folder`; paths receives the names of the files (one but for FILE_PER_LAYER).
bool renderer_write(const renderer_fact *fact, const scene *s, const view *v, const char *folder, char paths[FACT_FILES][256],
                    int *count, error *e);

#endif
