// Shell completions, made from the option table: what `make install` puts where the shells look.
#ifndef SSDO_CLI_COMPLETION_H
#define SSDO_CLI_COMPLETION_H

#include <stdbool.h>
#include <stdio.h>

// Values of a text option that this room does not know, such as the methods.
typedef struct completion_values {
    const char *option; // without dashes; NULL ends a list of these
    const char *words;  // separated by spaces
    bool list;          // several, separated by commas
} completion_values;

// shell: "bash" or "zsh".
void completion_print(FILE *to, const char *shell, const completion_values *values);

#endif
