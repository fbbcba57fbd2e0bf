// Words of options, each with the value it stands for, where more than the command line's table reads them: the parser, --help,
// the manual, completion, the header's record and messages take them from here. And the enums that hold the values.
#ifndef SSDO_BASE_WORDS_H
#define SSDO_BASE_WORDS_H

typedef struct option_word {
    const char *text;
    double value;
} option_word;

// Distance from the camera's plane or from the eye; or, for planar z: 1 / z with 0 behind everything; between near and far 0..1
// or 1..0; the hyperbolic 0..1 of a z-buffer, or that reversed (1 at near), or that as -1..1.
typedef enum depth_kind {
    DEPTH_AUTO,
    DEPTH_PLANAR,
    DEPTH_RADIAL,
    DEPTH_INVERSE,
    DEPTH_LINEAR,
    DEPTH_INVERTED,
    DEPTH_ZBUFFER,
    DEPTH_REVERSED,
    DEPTH_NDC,
    DEPTH_KINDS
} depth_kind;

typedef enum albedo_kind { ALBEDO_AUTO, ALBEDO_BASE, ALBEDO_DIFFUSE } albedo_kind;

// Of a vector pass.
typedef enum pass_space { SPACE_UNKNOWN, SPACE_WORLD, SPACE_CAMERA } pass_space;

// How a normal's components are stored. The unorm encodings hold u = (n + 1) / 2: as it is, or carried through a display curve
// (gamma 2.2, sRGB), or, where a reader took u for a display colour and linearised it, through that curve's inverse (degamma,
// desrgb).
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

// Each ends with a NULL text.
extern const option_word depth_kind_words[], albedo_kind_words[], pass_space_words[], normal_encoding_words[];

// The word for this value; NULL if there is none. words may be NULL.
const char *word_of(const option_word *words, double value);

#endif
