// --help and --completion: the option table, with the names that other rooms know (methods, bounces, layers).
#ifndef SSDO_PIPELINE_COMPLETE_H
#define SSDO_PIPELINE_COMPLETE_H

#include <stdio.h>

#include "cli/options.h"

void help_write(FILE *to);

// The completion script of a shell, or the table of methods for the manual or for passes/README.md.
void complete_write(FILE *to, completion_part part);

#endif
