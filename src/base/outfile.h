// A file that appears whole or not at all.
//
// The bytes go to a temporary file in the target's folder, named after host, process and a random number, so that two machines
// that write into one shared folder never meet. Commit flushes it to disk and renames it onto the target; abort removes it and
// leaves an older target as it was. A target that is a symbolic link keeps being one: what it points at is replaced.
//
// A process that is killed outright leaves its temporary file. The next one that begins (or tidies) the same target removes it,
// if it is sure that nobody is writing there: the name says the host, the boot and PID namespace, and a process that there is no
// more. What other machines left, or this one before it was last started, is theirs or unknown and stays.
#ifndef SSDO_BASE_OUTFILE_H
#define SSDO_BASE_OUTFILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"

enum { OUTFILE_TRACKED = 16 };

typedef struct outfile {
    int fd;       // open for reading and writing while the file is being made, otherwise -1
    char *temp;   // path of the temporary file, owned
    char *target; // path that commit renames it to, owned
    uint64_t end; // bytes that the file has after all that was put into it
    int code;     // errno of the first put that failed, 0 for none
} outfile;

#define OUTFILE_NONE ((outfile){.fd = -1})

// Creates the temporary file. A folder that is missing or cannot be written to is ERR_OUTPUT naming the folder; so is a target
// that is not a regular file.
bool outfile_begin(const char *path, outfile *out, error *e);

// Puts bytes at an offset; false (and `code`) when the system does not take all of them. One thread at a time.
bool outfile_put(outfile *out, const void *bytes, size_t size, uint64_t offset);

// The path that the file will really have, which the caller frees: links are followed, so that a link is not replaced by a plain
// file. ERR_OUTPUT where the system does not say.
char *outfile_target(const char *path, error *e);

// A whole file out of memory: begin, put, commit.
bool outfile_write(const char *path, const void *bytes, size_t size, error *e);

// Removes what a killed process left beside the target, as beginning does: for a target that is done already.
void outfile_tidy(const char *path);

// Whether the folder that the file is to be made in is there and can be written to, to be asked before long work: the error is
// outfile_begin's.
bool outfile_check_folder(const char *path, error *e);

// Flush, check that the file is as long as what was put into it, close, rename. After a put that failed, or on a failure here,
// the temporary file is removed and an older target stays as it was. *out is spent either way.
bool outfile_commit(outfile *out, error *e);

// Closes and removes the temporary file. Harmless on OUTFILE_NONE and on a spent outfile.
void outfile_abort(outfile *out);

// Removes the temporary files of the whole process that are neither committed nor aborted, up to OUTFILE_TRACKED of them. Safe in
// a signal handler, and meant for one that ends the process at once: the outfiles are not to be used afterwards.
void outfile_remove_all(void);

#endif
