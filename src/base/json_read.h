// A JSON file of a user's: read whole, and nothing after the value.
#ifndef SSDO_BASE_JSON_READ_H
#define SSDO_BASE_JSON_READ_H

#include <json-c/json_types.h>
#include <stddef.h>

#include "base/error.h"

// The file's one object, to be given back with json_object_put. NULL with ERR_USAGE, which calls the file `what` ("the camera
// file"), where it is not there, no regular file, no JSON in UTF-8, goes on after its value or holds something else than an
// object.
struct json_object *json_read_object(const char *path, const char *what, error *e);

// A number that is finite; false for anything else.
bool json_read_number(struct json_object *o, double *out);

// A list of `count` of them.
bool json_read_numbers(struct json_object *list, size_t count, double *out);

#endif
