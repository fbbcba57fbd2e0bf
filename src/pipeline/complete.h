// --completion: the script for a shell, with the names of methods and layers from their tables.
#ifndef SSDO_PIPELINE_COMPLETE_H
#define SSDO_PIPELINE_COMPLETE_H

#include <stdio.h>

// shell: "bash" or "zsh".
void complete_write(FILE *to, const char *shell);

#endif
