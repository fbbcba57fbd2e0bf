// What renderers call their channels and what they mean by them: one row a renderer. Everything a row says about meaning is a
// first guess, which measurement (positions.c, normals.c) may overrule and an option always does.
//
// A pattern is matched without regard to case, and to what joins the words of a name (space, _, -), against a channel group, that
// is a layer with its components:
//   "Position"   a layer of that name, or one that ends in ".Position" or ":Position": what stands before it is the view layer.
//                The layer's name is the channel's name up to its last dot, preceded by the part's name in a multi-part file.
//                Components are XYZ, RGB or red green blue for three; one of V Z X R Y T, red or nothing for one.
//   "depth/Z"    the same, and only this component.
//   "/"          the unnamed layer, whose channels have no dot (R, G, B, A), or the part that is the picture (picture.h); "/Z"
//                its channel Z, unless X and Y stand beside it.
//   "*/T"        any layer with the component T: for renderers whose layers are named by the user.
// Earlier patterns of a role are preferred. Of the rows, one whose header mark is present wins; else the one that recognises most
// roles (exact case counts a little more), the plain row winning ties. Roles the row does not find are looked for with the plain
// row's patterns.
//
// A header mark is an attribute's name, the beginning of one ("arnold/*"), or "name=beginning of its text".
#ifndef SSDO_GBUFFER_CONVENTIONS_H
#define SSDO_GBUFFER_CONVENTIONS_H

#include <stdbool.h>

#include "gbuffer/encoding.h"
#include "gbuffer/resolution.h"

enum { CONVENTION_PATTERNS = 10, CONVENTION_MARKS = 4 };

// Where a header keeps the camera, for files whose positions do not tell. worldToNDC and worldToCamera are read in any row.
typedef struct header_camera {
    const char *fov;      // horizontal field of view: a number, or a text that holds one
    bool radians;         // else degrees
    const char *pose;     // 4 x 4 for row vectors, camera to world
    bool world_to_camera; // the pose is the other way round
    bool looks_along_z;   // the pose's camera looks along +z (RenderMan), else along -z (OpenGL)
    const char *angles;   // instead of a pose: what stands before "Rot/yaw" (degrees) and "Pos/x", Unreal's axes
} header_camera;

typedef struct convention {
    const char *name;
    bool confirmed;                      // by a file of the renderer itself, not only by its documentation
    const char *marks[CONVENTION_MARKS]; // that only this renderer writes
    const char *patterns[ROLE_COUNT][CONVENTION_PATTERNS];
    const char *diffuse_albedo[4]; // those patterns of ROLE_ALBEDO that name a diffuse albedo; the others are `albedo`
    albedo_kind albedo;
    pass_space position_space, normal_space;
    normal_encoding normal_encoding;
    bool normals_averaged; // edge pixels hold the average of the normals, so |N| is coverage
    depth_kind depth;
    double background_depth;
    bool up_is_z;
    header_camera camera;
} convention;

extern const convention conventions[];
extern const int convention_count;

// The row of a resolution's `convention`; the plain row when there is none of that name.
const convention *convention_named(const char *name);

// Whether any row has the name as a layer of the role.
bool convention_knows(role r, const char *name);

#endif
