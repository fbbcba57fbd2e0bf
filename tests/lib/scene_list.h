// The generated scenes that bench and tests go through, each with the kind of camera that looks at it.
#ifndef SSDO_TESTS_SCENE_LIST_H
#define SSDO_TESTS_SCENE_LIST_H

#include "scene_picture.h"

typedef struct listed_scene {
    const char *name;
    void (*build)(scene *s);
    bool orthographic;
} listed_scene;

extern const listed_scene scene_list[]; // ends with a NULL name

// The scene's own view: 50 degrees, or 6 scene units wide.
view listed_view(const listed_scene *l, const scene *s, int width, int height);

// Five bent spheres of 512 triangles on a plane. The meshes lie in static memory, the same for every scene built: to be built on
// one thread, and never placed elsewhere.
void scene_rocks(scene *s);

#endif
