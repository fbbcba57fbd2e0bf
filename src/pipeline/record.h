// What decides the bytes of a frame's output, as digests: the header attribute ssdo/digest, by which --skip-existing tells what
// is done.
//
// The attribute is RECORD_TEXT characters: two digests of settings, shaders, code that decides pixels, radius and the content of
// every file that is read (by samples; of all bytes, or dashes where nobody asked for that), and one of the output's own parts,
// channels, windows and compression, which tells when another program has cropped it or taken layers out. No time, path or host.
#ifndef SSDO_PIPELINE_RECORD_H
#define SSDO_PIPELINE_RECORD_H

#include "base/digest.h"
#include "exr/write.h"

struct job;

#define RECORD_NAME "ssdo/digest"
enum { RECORD_TEXT = 3 * DIGEST_TEXT + 2 };

typedef struct frame_record {
    bool made; // false: nobody wants one, and the output has none
    bool has_exact;
    digest sampled, exact;
    digest preview; // that of the preview: it depends on the display too
    error refusal;  // of the system, to look into a file that counts: `made` is false
} frame_record;

// Before the frame's pixels are read, so that a file that changes meanwhile counts as changed. A file that does not exist, or
// that the system refuses, is no error here: reading it says more, and record_check what is left. Without job->files the record
// is not made.
bool record_make(const struct job *j, int frame, frame_record *out, error *e);

// Before the output is written: ERR_INPUT if a file that counts could be read for its pixels, but not for the record.
bool record_check(const frame_record *r, error *e);

// What the parts of a file that will be written, or was, look like from outside.
digest record_layout(const exrio_out_part *parts, int count);
digest record_layout_of_file(const exrio_file *file);

void record_format(const frame_record *r, digest layout, char text[RECORD_TEXT + 1]);
// True if the text says that a file of this layout was made as `r` says.
bool record_fits(const frame_record *r, digest layout, const char *text);

#endif
