#include "base/json_read.h"

#include <json-c/json.h>
#include <math.h>
#include <stdlib.h>

#include "base/infile.h"

enum { MOST_BYTES = 1 << 24 };

static void refuse(const char *path, const char *what, const char *why, error *e)
{
    err_set(e, ERR_USAGE, path, NULL, "%s cannot be read as JSON: %s", what, why);
}

struct json_object *json_read_object(const char *path, const char *what, error *e)
{
    size_t length = 0;
    char *text = infile_text(path, (infile_kind){what, ERR_USAGE}, MOST_BYTES, &length, e);
    if (!text) return NULL;
    struct json_object *root = NULL;
    struct json_tokener *reader = json_tokener_new();
    if (!reader) {
        err_set(e, ERR_MEMORY, path, NULL, "out of memory");
        goto out;
    }
    // Strict: nothing after the value, no NaN, no comment, text in UTF-8.
    json_tokener_set_flags(reader, JSON_TOKENER_STRICT | JSON_TOKENER_VALIDATE_UTF8);
    root = json_tokener_parse_ex(reader, text, (int)length + 1); // the final 0 ends a number
    enum json_tokener_error code = json_tokener_get_error(reader);
    if (code != json_tokener_success)
        refuse(path, what, code == json_tokener_continue ? "it ends too early" : json_tokener_error_desc(code), e);
    else if (json_tokener_get_parse_end(reader) != length)
        refuse(path, what, "something follows its value", e);
    else if (!json_object_is_type(root, json_type_object))
        err_set(e, ERR_USAGE, path, NULL, "%s must hold one JSON object", what);
    if (e->code != ERR_NONE) {
        json_object_put(root);
        root = NULL;
    }
    json_tokener_free(reader);
out:
    free(text);
    return root;
}

bool json_read_number(struct json_object *o, double *out)
{
    if (!json_object_is_type(o, json_type_double) && !json_object_is_type(o, json_type_int)) return false;
    *out = json_object_get_double(o);
    return isfinite(*out);
}

bool json_read_numbers(struct json_object *list, size_t count, double *out)
{
    if (!json_object_is_type(list, json_type_array) || json_object_array_length(list) != count) return false;
    for (size_t i = 0; i < count; i++)
        if (!json_read_number(json_object_array_get_idx(list, i), &out[i])) return false;
    return true;
}
