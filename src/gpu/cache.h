// Linked programs kept on disk, so that a second run of the tool compiles no shader.
//
// The folder is $XDG_CACHE_HOME/ssdo-filter, else ~/.cache/ssdo-filter; without either there is no cache. An entry is named by a
// hash of the driver's renderer and version strings and of the whole source; entries that are damaged, cut short or another
// driver's are ignored and written anew. Entries appear whole. Nothing here fails: the worst case is a compilation. On llvmpipe
// the binary holds Mesa's intermediate form; the machine code made of it lies in Mesa's own cache, which is put beside it.
#ifndef SSDO_GPU_CACHE_H
#define SSDO_GPU_CACHE_H

#include "gpu/gpu.h"

// Makes the folder if need be. False when there is none.
bool cache_folder(char *path, size_t size);

// Fills the fresh program `program` from the cache; false: it must be compiled.
bool cache_load(const gpu *g, const char *source, GLuint program);

// Keeps a linked program (linked with GL_PROGRAM_BINARY_RETRIEVABLE_HINT).
void cache_store(const gpu *g, const char *source, GLuint program);

// Before EGL starts: Mesa's cache of machine code goes into our folder too, unless the user has said where; it is switched off
// where that folder is not ours alone or its disk is nearly full, because Mesa would be ended by SIGBUS there.
void cache_point_mesa(void);

#endif
