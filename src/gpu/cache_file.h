// Files of the cache, inside the gpu room only. Whatever lies in the folder, nothing here waits, follows a link or fails with
// more than "not there".
#ifndef SSDO_GPU_CACHE_FILE_H
#define SSDO_GPU_CACHE_FILE_H

#include <stdbool.h>
#include <stddef.h>

enum { CACHE_PATH = 1024 };

// Makes the folder if need be. False where another user owns it or may write into it: it may hold anything.
bool cache_own_folder(const char *path);

// A whole file, which the caller frees. NULL if it is no regular file of this user, is empty or has more than 16 MiB.
void *cache_read(const char *path, size_t *size);

// The file appears whole or not at all.
bool cache_write(const char *path, const void *bytes, size_t size);

// Calls `take` for the names in a folder that do not begin with a dot, in no order.
void cache_each(const char *folder, void (*take)(void *context, const char *folder, const char *name), void *context);

// Removes the oldest of the files that `counts` accepts, if there are more than `most`, until a quarter is free.
void cache_trim(const char *folder, bool (*counts)(const char *name), size_t most);

#endif
