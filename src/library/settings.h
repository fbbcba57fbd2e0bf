// The settings of a context: the program's options, made one by one.
#ifndef SSDO_LIBRARY_SETTINGS_H
#define SSDO_LIBRARY_SETTINGS_H

#include "library/objects.h"

// Makes a setting, or with value NULL takes it back, if all settings together are then right; else nothing changes.
bool settings_make(ssdo_context *c, const char *name, const char *value, error *e);
// What the settings say.
bool settings_parse(const ssdo_context *c, options *o, error *e);
void settings_free(ssdo_context *c);

#endif
