// Shell completions, made from the option table: what `make install` puts where the shells look.
#ifndef SSDO_CLI_COMPLETION_H
#define SSDO_CLI_COMPLETION_H

#include <stdbool.h>
#include <stdio.h>

#include "cli/options_table.h"

// For zsh, or for bash. The lists of values end at a NULL option.
void completion_print(FILE *to, bool zsh, const option_values *values);

#endif
