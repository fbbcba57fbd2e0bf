// The rows behind cli/options.h: one row an option, in the order of --help and the man page.
//
// To add an option: add its field to `options`, its default to options_defaults() if that is not zero, and a row to
// options_table.c. Parser, --help, man page and header record follow from the row; the man page's OPTIONS section is rewritten by
// `SSDO_UPDATE_MAN=1 build/tests/test_cli_man`.
#ifndef SSDO_CLI_OPTIONS_TABLE_H
#define SSDO_CLI_OPTIONS_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "base/words.h"

typedef enum option_kind {
    OPT_FLAG,   // bool, no argument: becomes true; with words, one may follow "=" and sets a second bool
    OPT_SWITCH, // bool, one of the words
    OPT_ENUM,   // int or enum, one of the words
    OPT_TEXT,   // const char *, any text
    OPT_PATHS,  // path_list: a file name, once for each time that the option is given
    OPT_PATH,   // const char *, a file name; the header record keeps only its base name
    OPT_INT,    // int in [min, max], or one of the words
    OPT_REAL,   // double in [min, max], or one of the words
    OPT_RANGE,  // double[2]: two rising numbers of at least 0, in two arguments or one with a comma
    OPT_RADIUS, // radius and radius_unit: a length, "40px" or "auto"
} option_kind;

typedef enum option_group {
    GROUP_OUTPUT,
    GROUP_ESTIMATOR,
    GROUP_BOUNCE,
    GROUP_ENVIRONMENT,
    GROUP_COMPOSITE,
    GROUP_CHANNELS,
    GROUP_CAMERA,
    GROUP_RUN,
    GROUP_COUNT
} option_group;

typedef struct option_row {
    const char *name;         // without dashes
    char letter;              // short form, 0 for none
    const char *argument;     // as shown in the help; NULL for a flag and for one that is a word of the list
    option_kind kind;         //
    size_t offset;            // of the field in `options`
    const option_word *words; // ends with a NULL text; NULL for none
    size_t word_offset;       // of a flag's second bool
    double min, max;          // bounds of a number
    bool open;                // the bounds themselves are not allowed
    bool may_be_empty;        // an OPT_TEXT may be ""
    option_group group;
    bool pixels;          // changes pixels or which layers exist: belongs into the header record
    bool bytes;           // changes no pixel but how the file is laid out
    const char *fallback; // the default as the help shows it; NULL when "not given" needs no words
    bool hidden;          // for build scripts: not in the help, the manual and the completions
    const char *help;     // whole sentences
} option_row;

extern const option_row option_rows[];
extern const int option_row_count;

enum { OPTION_ARGUMENT = 128 }; // bytes for the words of any option, with bars between

// What follows the option, as shown in the help: the argument, or the words ("radiance|visibility"); "" for a flag. buf is
// scratch.
const char *option_argument(const option_row *row, char *buf, size_t size);

// Values of a text option that this room does not know, such as the methods.
typedef struct option_value {
    const char *text, *help; // help: a phrase, or NULL
} option_value;
typedef struct option_values {
    const char *option;         // without dashes; NULL ends a list of these
    const option_value *values; // ends with a NULL text
    bool list;                  // several, separated by commas
} option_values;

// The whole of --help. values: of options whose words this room does not know; NULL: none.
void options_print_help(FILE *to, const option_values *values);

// The values of this option; NULL if there are none.
const option_values *option_values_of(const option_values *v, const char *option);

// The heading of a group.
const char *option_group_title(option_group g);

#endif
