// Which part of a multi-part file is the picture, so that its bare channels (R, G, B, A, and the depth Z beside them) are read as
// a single-part file's nameless ones. Its name tells nothing: rgba, persp, the camera's, the view layer's. Internal to the room.
#ifndef SSDO_GBUFFER_PICTURE_H
#define SSDO_GBUFFER_PICTURE_H

#include "gbuffer/layers.h"

// Marks the entries of the picture, in each view: where a part is called like a picture, that one if it holds Z too (else
// patterns find it); otherwise the part with R, G, B and Z, or all of them if there are several, which are view layers then;
// otherwise the first part with R, G, B and A whose name is of no other pass.
void picture_mark(layer_index *index);

#endif
