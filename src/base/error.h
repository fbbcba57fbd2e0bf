// One error type for the whole program.
//
// A function that can fail takes an `error *` as its last argument and returns false (or NULL) after filling it. Nobody below
// main() prints or exits. The message is one sentence that says what is wrong and what the user can do about it; file and
// channel are kept apart so that the report can name them. The first error wins: err_set on an error that is already set keeps
// the older one, because the cause comes before its consequences.
#ifndef SSDO_BASE_ERROR_H
#define SSDO_BASE_ERROR_H

#include <stdbool.h>

// The values are the process's exit codes (also in the man page).
typedef enum error_code {
    ERR_NONE = 0,
    ERR_FRAMES = 1, // some frames of a sequence failed
    ERR_USAGE = 2,
    ERR_INPUT = 3,
    ERR_OUTPUT = 4,
    ERR_GL = 5,
    ERR_MEMORY = 6,
    ERR_DOUBT = 7, // --strict
} error_code;

typedef struct error {
    error_code code;
    char message[4096]; // without file name; a complete sentence without the final full stop; lists of channels are long
    char file[512];     // "" when no file is concerned
    char channel[256];  // "" when no channel is concerned
    int refused;        // errno of the system call that failed, where what the file holds may be right; else 0
} error;

// Fills *e (unless it holds an error already, or is NULL) and returns false, so that `return err_set(...)` reads well.
// file and channel may be NULL.
bool err_set(error *e, error_code code, const char *file, const char *channel, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

// err_set, and says that it was the system that refused: `number` is errno's value, which the message ends with.
bool err_set_system(error *e, error_code code, int number, const char *file, const char *what);

enum { ERROR_TEXT = 4096 + 512 + 256 + 64 }; // room for all of it

// "file: message (channel 'c')" into buf, always terminated.
void err_format(const error *e, char *buf, unsigned long size);

#endif
