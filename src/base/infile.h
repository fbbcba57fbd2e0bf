// Files that are read: looked at before they are opened.
//
// Opening a pipe waits for somebody who writes into it, opening a device may do anything, and /dev/zero never ends. Whatever the
// program reads is therefore a regular file, or it is refused with a sentence; every file of a user's choice is opened here or
// checked here before a library opens it.
#ifndef SSDO_BASE_INFILE_H
#define SSDO_BASE_INFILE_H

#include <stddef.h>

#include "base/error.h"

// What kind of file, for the sentence ("the environment map"; NULL: the sentence begins with its verb, after the file's name),
// and the error's code.
typedef struct infile_kind {
    const char *what;
    error_code code;
} infile_kind;

// A descriptor for reading, which the caller closes, and the file's size; -1 with an error for a file that is not there, cannot
// be opened or is no regular file. `size` may be NULL.
int infile_open(const char *path, infile_kind kind, size_t *size, error *e);

// Whether infile_open would succeed: for a file that a library opens by its name.
bool infile_check(const char *path, infile_kind kind, error *e);

// Whether there is a file of this name, of any kind. That the system does not say is an error and no answer: `there` is set only
// where the function returns true.
bool infile_exists(const char *path, infile_kind kind, bool *there, error *e);

// The whole file and a final 0, which the caller frees; NULL with an error, also where it has more than `most` bytes. `length`
// may be NULL.
char *infile_text(const char *path, infile_kind kind, size_t most, size_t *length, error *e);

// Reads n bytes from `offset` on and says how many there were: fewer at the file's end (errno is 0) and at an error (errno says
// which).
size_t infile_read_at(int fd, void *to, size_t n, size_t offset);

#endif
