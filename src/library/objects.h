// What a context and a frame of ssdo.h hold.
#ifndef SSDO_LIBRARY_OBJECTS_H
#define SSDO_LIBRARY_OBJECTS_H

#include <pthread.h>

#include "library/worker.h"
#include "pipeline/frame.h"
#include "ssdo.h"

// A setting as it was made. The text stays until the context ends: options and frames point into it.
typedef struct setting {
    char *text; // "--name=value" or "--name"
    struct setting *next;
    const char *name; // of the option's row
    bool gone;        // made again, or taken back
} setting;

struct ssdo_context {
    pthread_mutex_t call; // one call at a time
    worker worker;        // owns the GL context
    ssdo_setup setup;
    setting *settings; // the last one first
    options o;         // what they say
    log_t log;
    job job;
    bool opened;        // job is,
    options opened_for; // on the device that these ask for
    volatile int stop;  // by ssdo_stop
    error e;
    char message[ERROR_TEXT];
};

struct ssdo_frame {
    const ssdo_context *maker; // never looked into: the context may be gone
    options o;                 // of the time when it was filtered
    frame_result result;
    char device[sizeof(((gpu *)0)->device)]; // that filtered it
    int memory;                              // descriptor of a G-buffer in memory, or -1
};

#endif
