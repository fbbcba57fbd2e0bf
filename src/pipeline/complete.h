// --help and --completion: the option table, with the names that other rooms know (methods, bounces, layers).
#ifndef SSDO_PIPELINE_COMPLETE_H
#define SSDO_PIPELINE_COMPLETE_H

#include <stdio.h>

void help_write(FILE *to);

// what: "bash" or "zsh", the completion script of this shell; "methods.1" or "methods.md", the table of methods for the manual or
// for passes/README.md.
void complete_write(FILE *to, const char *what);

#endif
