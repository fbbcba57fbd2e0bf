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

// Mesa's cache of machine code, which a program's binary does not hold on llvmpipe. Mesa does not bind an entry to its key, so
// the entries lie in a folder of ours under names that do, and each process has a folder of its own in which Mesa sees those that
// hold (hard links). Before EGL starts, and before the first thread: the environment variables MESA_SHADER_CACHE_DIR and
// MESA_DISK_CACHE_MULTI_FILE are set, or MESA_SHADER_CACHE_DISABLE where there is no folder or its disk is nearly full, because
// Mesa would be ended by SIGBUS there. What the user has set stays and is the user's. Nothing is done where it is open already.
void cache_open_mesa(void);

// After EGL has ended: takes over what Mesa has added, and leaves the process's folder, empty, to the next process.
void cache_close_mesa(void);

#endif
