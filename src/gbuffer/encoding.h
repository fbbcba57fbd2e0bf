// The space of a vector pass and how a normal's components are stored. Internal to the room.
#ifndef SSDO_GBUFFER_ENCODING_H
#define SSDO_GBUFFER_ENCODING_H

#include <stdbool.h>

#include "base/vec.h"

typedef enum pass_space { SPACE_UNKNOWN, SPACE_WORLD, SPACE_CAMERA } pass_space;

// The unorm encodings hold u = (n + 1) / 2: as it is, or carried through a display curve (gamma 2.2, sRGB), or, where a reader
// took u for a display colour and linearised it, through that curve's inverse (degamma, desrgb).
typedef enum normal_encoding {
    NORMAL_SIGNED,
    NORMAL_UNORM,
    NORMAL_GAMMA,
    NORMAL_SRGB,
    NORMAL_DEGAMMA,
    NORMAL_DESRGB,
    NORMAL_ENCODINGS,
    NORMAL_AUTO = NORMAL_ENCODINGS // of an option: to be found
} normal_encoding;

// What it means in a sentence.
const char *encoding_text(normal_encoding e);
// By its word in --normal-encoding; NORMAL_AUTO for NULL.
normal_encoding encoding_named(const char *word);

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
