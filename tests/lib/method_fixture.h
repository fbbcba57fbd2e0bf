// A generated scene, ready to hold a method to its reference A on stratified pixels.
#ifndef SSDO_TESTS_METHOD_FIXTURE_H
#define SSDO_TESTS_METHOD_FIXTURE_H

#include "method_reference.h"
#include "rig.h"
#include "scene_list.h"

enum { FIXTURE_PIXELS = 4096 };

typedef struct fixture {
    scene s;
    view v;
    gbuffer gb;
    layer l;
    pixel pixels[FIXTURE_PIXELS];
    int count;
    double expected[FIXTURE_PIXELS]; // open shares
} fixture;

// The scene as `v` sees it, and up to `pixels` of its pixels.
bool fixture_open(fixture *f, const scene *s, const view *v, int pixels, error *e);
void fixture_close(fixture *f);

// Fills `expected` from the method's reference, on all threads.
void fixture_expect(fixture *f, const method *m, const pass_settings *set, bool fine);

typedef struct figures {
    double rmse, bias;
} figures;
// The method's occlusion against `expected`.
bool fixture_compare(const fixture *f, rig *r, const method *m, const pass_settings *set, figures *out, error *e);

#endif
