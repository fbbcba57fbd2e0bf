// The readings of a normal pass, and which of them the surfaces bear out. Internal to the room.
#ifndef SSDO_GBUFFER_NORMAL_HYPOTHESES_H
#define SSDO_GBUFFER_NORMAL_HYPOTHESES_H

#include "gbuffer/encoding.h"
#include "gbuffer/evidence.h"
#include "gbuffer/verdict.h"

// Where the axes of a reading come from, in the order in which they are preferred.
typedef enum reading_source {
    FROM_CAMERA,   // the axes of a camera
    FROM_KNOWN,    // the rotation of a flag or of the positions
    FROM_HEADER,   // the header's camera
    FROM_ESTIMATE, // the rotation that the normals and the surfaces give
    READING_SOURCES
} reading_source;

// How likely a reading is beforehand: the renderer's own; world or camera space as they are commonly stored; the axes in any
// order and sign, or a display curve; a rotation nothing else knows of.
typedef enum reading_kind { KIND_OWN, KIND_PLAIN, KIND_TURNED, KIND_ESTIMATE, KINDS } reading_kind;

typedef struct reading {
    mat3 to_camera;
    normal_encoding encoding;
    reading_source source;
    reading_kind kind;
    mat3 turned;      // signed permutation of the axes that comes on top: the stored axes' for a world, the camera's otherwise
    bool inverse;     // FROM_HEADER: the matrix is the inverse of what the row says
    double fit, loss; // median cosine; mean of 1 - cosine, a sample at most 0.3
    double follows;   // correlation between the normals and the surface's, about their means; 1 where all faces one way
} reading;

typedef struct normal_choice {
    reading best;
    double turn;  // degrees between the best reading and the rotation that would fit best
    bool one_way; // the stored normals hardly vary while the surfaces do
    double next;  // median cosine of the next best reading; NaN without
} normal_choice;

// Tries every reading that the options leave. False, with the error set, only for want of memory.
bool normals_choose(const build *b, const evidence *v, verdict *list, normal_choice *out);

// Whether the best reading can be relied on (the numbers are in the file).
bool normals_believed(const normal_choice *c, const evidence *v);

// "world space, 0..1 encoded" into buf.
void reading_describe(const build *b, const reading *r, char *buf, size_t size);

#endif
