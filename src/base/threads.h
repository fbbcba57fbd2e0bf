// A parallel loop over independent items. Results must not depend on the number of threads or on the order of items.
#ifndef SSDO_BASE_THREADS_H
#define SSDO_BASE_THREADS_H

#include <stdbool.h>
#include <stddef.h>

// Does one item. `worker` is 0 .. threads-1, constant for one thread, for scratch memory. Returns false to stop the loop early
// (items already under way finish).
typedef bool (*threads_fn)(void *context, size_t item, int worker);

// Runs fn for items 0 .. count-1 on up to `threads` threads (the caller is one of them); items are handed out in rising order.
// Returns false if any item returned false. With threads <= 1, or if no thread can be started, it runs in the caller.
bool threads_for(int threads, size_t count, threads_fn fn, void *context);

// Whether a thread may start while another one loads libraries. `libc_version`: of glibc, NULL for the one that runs. One before
// 2.34 ends the process if the two meet.
bool threads_start_beside_loading(const char *libc_version);

// Threads to use when the user names none: the CPUs this process may run on (affinity), at least 1.
int threads_default(void);

#endif
