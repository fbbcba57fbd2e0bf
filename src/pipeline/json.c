#include "pipeline/json.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "base/outfile.h"

void json_put(json_object *o, const char *key, json_object *value) { json_object_object_add(o, key, value); }

void json_put_text(json_object *o, const char *key, const char *s) { json_put(o, key, s ? json_object_new_string(s) : NULL); }

void json_put_number(json_object *o, const char *key, double v)
{
    json_put(o, key, v - v == 0.0 ? json_object_new_double(v) : NULL);
}

json_object *json_time(const char *name, double wall, double cpu)
{
    json_object *o = json_object_new_object();
    json_put_text(o, "stage", name);
    json_put_number(o, "wall_ms", wall);
    json_put_number(o, "cpu_ms", cpu);
    return o;
}

bool json_save(json_object *o, const char *path, error *e)
{
    const char *text =
        json_object_to_json_string_ext(o, JSON_C_TO_STRING_PRETTY | JSON_C_TO_STRING_SPACED | JSON_C_TO_STRING_NOSLASHESCAPE);
    outfile out = OUTFILE_NONE;
    bool ok = outfile_begin(path, &out, e);
    if (ok && dprintf(out.fd, "%s\n", text) < 0)
        ok = err_set(e, ERR_OUTPUT, path, NULL, "the report cannot be written: %s; free some space or choose another folder",
                     strerror(errno));
    if (ok)
        ok = outfile_commit(&out, e);
    else
        outfile_abort(&out);
    json_object_put(o);
    return ok;
}
