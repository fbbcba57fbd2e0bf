// The files of a run: one table of what is read and what is written, in every frame or in all of them.
#ifndef SSDO_PIPELINE_FILES_H
#define SSDO_PIPELINE_FILES_H

#include <stdbool.h>
#include <stddef.h>

#include "base/content.h"
#include "cli/frames.h"
#include "cli/options.h"

enum { FILE_PATH = 4096 };

typedef enum file_kind { FILE_DATA, FILE_COLOURS, FILE_OUTPUT, FILE_PREVIEW, FILE_REPORT } file_kind;

typedef struct run_file {
    const char *what; // as messages call it: "the output", "--env"
    const char *path; // as given: for a framed file, a pattern. Borrowed from the options, or one of `owned`
    file_kind kind;   // FILE_OUTPUT and what follows it are written
    bool framed;      // it is another file in each frame
    bool decides;     // the pixels of the output depend on its content
    bool once;        // it is read once for all frames
    int every;        // of frames whose number is a multiple of this
    bool known;       // `content` is that of the whole run
    content content;
    error refusal; // of the system, to look into it: `content` is zero
} run_file;

typedef struct run_files {
    run_file *list; // owned
    int count;
    char **owned;
    int owned_count;
    frame_list shot; // the frames that --surround shot chose, files of the list; owned
} run_files;

// ERR_INPUT where the system does not say what is there. Lists inputs, --also, the frames of --surround shot, environment,
// camera, proxies, mesh and its material files, OpenColorIO config, output, preview and report. A mesh that cannot be read has no
// material files here; reading it says why.
bool run_files_list(const options *o, run_files *out, error *e);
void run_files_free(run_files *files);

// Looks into the files that are read once for all frames; false with ERR_MEMORY. That the system refuses one is kept with it.
bool run_files_read(run_files *files, const options *o, error *e);

// The file's path in a frame. False if it has none there, or one that does not fit.
bool run_file_path(const run_file *file, int frame, char *path, size_t size);

// Compares, for all frames at once, every file that will be written with every other file, through links and under whatever
// names: ERR_USAGE if what is written to is read, or written twice; ERR_INPUT where the system does not say. frames: of a
// sequence; a single frame has one, of any number.
bool run_files_check(const run_files *files, const int *frames, int frame_count, error *e);

// Whether --proxies names a file a frame. ERR_INPUT where the system does not say whether there is a file of exactly its name.
bool proxies_are_framed(const options *o, bool *framed, error *e);

#endif
