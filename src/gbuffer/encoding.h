// How a normal's components are stored. Internal to the room.
#ifndef SSDO_GBUFFER_ENCODING_H
#define SSDO_GBUFFER_ENCODING_H

#include <stdbool.h>

#include "base/vec.h"
#include "base/words.h"

// What it means in a sentence.
const char *encoding_text(normal_encoding e);

// The normal that a stored value means, not normalised. Values beyond 0..1, as filters with negative lobes leave them, follow the
// curve's mirror image below 0 and the curve itself above 1.
vec3 encoding_undo_curve(normal_encoding e, vec3 stored);
static inline vec3 encoding_decode(normal_encoding e, vec3 s)
{
    if (e == NORMAL_SIGNED) return s;
    if (e == NORMAL_UNORM) return v3(2.0 * s.x - 1.0, 2.0 * s.y - 1.0, 2.0 * s.z - 1.0);
    return encoding_undo_curve(e, s);
}

#endif
