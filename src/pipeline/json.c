#include "pipeline/json.h"

#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/outfile.h"
#include "base/text.h"

void json_put(json_object *o, const char *key, json_object *value) { json_object_object_add(o, key, value); }

json_object *json_text(const char *s)
{
    if (!s) return NULL;
    size_t capacity = text_utf8_room(s);
    char *text = malloc(capacity);
    if (!text) return NULL;
    text_utf8(s, text, capacity);
    json_object *o = json_object_new_string(text);
    free(text);
    return o;
}

void json_add_text(void *list, const char *s) { json_object_array_add(list, json_text(s)); }

void json_put_text(json_object *o, const char *key, const char *s) { json_put(o, key, json_text(s)); }

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
    size_t n = text ? strlen(text) : 0;
    char *lines = text ? mem_zero(n + 2, 1, e) : NULL;
    if (lines) memcpy(lines, text, n);
    if (lines) lines[n] = '\n';
    bool ok = lines && outfile_write(path, lines, n + 1, e);
    if (!text) err_set(e, ERR_MEMORY, path, NULL, "out of memory while writing the report");
    free(lines);
    json_object_put(o);
    return ok;
}
