// What a second run of the tool need not compile again, kept on disk.
//
// The folder is $XDG_CACHE_HOME/ssdo-filter, else ~/.cache/ssdo-filter; without either there is no cache. An entry is bound to
// its key: a linked program to the driver's renderer and version strings and the whole source, machine code to Mesa's own key.
// Entries that are damaged, cut short, exchanged or another driver's are ignored and made anew; what is no regular file of this
// user is never opened for long nor followed. Entries appear whole. Nothing here fails: the worst case is a compilation.
#ifndef SSDO_GPU_CACHE_H
#define SSDO_GPU_CACHE_H

#include "gpu/gpu.h"

// Makes the folder if need be. False when there is none.
bool cache_folder(char *path, size_t size);

// Fills the fresh program `program` from the cache; false: it must be compiled.
bool cache_load(const gpu *g, const char *source, GLuint program);

// Keeps a linked program (linked with GL_PROGRAM_BINARY_RETRIEVABLE_HINT).
void cache_store(const gpu *g, const char *source, GLuint program);

// Removes the oldest programs where there are thousands: after a run that has stored some.
void cache_tidy(void);

// Opens Mesa's cache of machine code; on llvmpipe a program's binary does not hold that code. Mesa does not check whether an
// entry belongs to its key. So the entries lie in a folder of ours, under names that say which key and content they have, and
// each process has a folder of its own with hard links to those that are sound. To be called before EGL and before the first
// thread start, for it sets the environment variables MESA_SHADER_CACHE_DIR and MESA_DISK_CACHE_MULTI_FILE. Where there is no
// folder, or its disk is nearly full, it sets MESA_SHADER_CACHE_DISABLE instead, because Mesa would be ended by SIGBUS there. It
// leaves alone what the user has set. A second call does nothing.
void cache_open_mesa(void);

// After EGL has ended: takes over what Mesa has added, and leaves the process's folder, empty, to the next process.
void cache_close_mesa(void);

#endif
