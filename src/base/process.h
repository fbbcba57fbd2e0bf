// Which process left a file behind, and whether it may be cleaned away.
#ifndef SSDO_BASE_PROCESS_H
#define SSDO_BASE_PROCESS_H

#include <stdbool.h>
#include <stdint.h>

// Says where a process id means something: this boot of this machine, this PID namespace (containers may share a host's name but
// not their processes). 0 where /proc does not tell.
uint64_t process_place(void);

// True if the process with this number, of this place, is known to have ended.
bool process_is_gone(long pid, uint64_t place);

#endif
