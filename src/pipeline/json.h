// What the reports share: json-c with fewer words. A number that is not finite becomes null.
#ifndef SSDO_PIPELINE_JSON_H
#define SSDO_PIPELINE_JSON_H

#include <json-c/json.h>
#include <stdbool.h>

#include "base/error.h"

// A string in UTF-8 whatever `s` holds (base/text.h); NULL becomes null.
json_object *json_text(const char *s);
// Appends one to a list (a json_object *).
void json_add_text(void *list, const char *s);

void json_put(json_object *o, const char *key, json_object *value);
void json_put_text(json_object *o, const char *key, const char *s);
void json_put_number(json_object *o, const char *key, double v);
// {"stage": name, "wall_ms": .., "cpu_ms": ..}
json_object *json_time(const char *name, double wall, double cpu);

// Writes the object to a file, whole or not at all, and frees it.
bool json_save(json_object *o, const char *path, error *e);

#endif
