#include "light/proxies.h"

#include <json-c/json.h>
#include <math.h>
#include <stdlib.h>

#include "base/json_read.h"
#include "base/mem.h"

static const double ALBEDO = 0.5; // of a sphere that names none

static bool read_albedo(struct json_object *o, double out[3])
{
    out[0] = out[1] = out[2] = ALBEDO;
    if (!o) return true;
    if (json_read_number(o, &out[0]))
        out[1] = out[2] = out[0];
    else if (!json_read_numbers(o, 3, out))
        return false;
    return fmin(out[0], fmin(out[1], out[2])) >= 0.0 && fmax(out[0], fmax(out[1], out[2])) <= 1.0;
}

// NULL, or what is wrong.
static const char *read_sphere(struct json_object *o, sphere_proxy *s)
{
    struct json_object *centre = NULL, *radius = NULL, *albedo = NULL;
    double c[3];
    if (!json_object_is_type(o, json_type_object)) return "is not an object";
    json_object_object_get_ex(o, "centre", &centre);
    json_object_object_get_ex(o, "radius", &radius);
    json_object_object_get_ex(o, "albedo", &albedo);
    if (!json_read_numbers(centre, 3, c)) return "needs a \"centre\" of three numbers";
    if (!json_read_number(radius, &s->radius) || !(s->radius > 0.0)) return "needs a \"radius\" above 0";
    if (!read_albedo(albedo, s->albedo)) return "has an \"albedo\" that is neither a number nor three numbers from 0 to 1";
    s->centre = v3(c[0], c[1], c[2]);
    return NULL;
}

bool proxies_load(const char *path, proxy_set *out, error *e)
{
    *out = (proxy_set){0};
    struct json_object *list = NULL, *root = json_read_object(path, "the proxies file", e);
    if (!root) return false;
    bool ok = json_object_object_get_ex(root, "spheres", &list) && json_object_is_type(list, json_type_array);
    size_t n = ok ? json_object_array_length(list) : 0;
    if (!ok)
        err_set(e, ERR_USAGE, path, NULL, "a proxies file holds one object with a list named \"spheres\"");
    else if (n > PROXIES_MAX)
        ok = err_set(e, ERR_USAGE, path, NULL, "there are %zu spheres; at most %d are taken", n, PROXIES_MAX);
    else
        ok = (out->spheres = mem_zero(n, sizeof *out->spheres, e)) != NULL;
    for (size_t i = 0; ok && i < n; i++) {
        const char *wrong = read_sphere(json_object_array_get_idx(list, i), &out->spheres[i]);
        if (wrong) ok = err_set(e, ERR_USAGE, path, NULL, "sphere %zu %s", i + 1, wrong);
        out->count += ok;
    }
    json_object_put(root);
    if (!ok) proxies_free(out);
    return ok;
}

void proxies_free(proxy_set *set)
{
    free(set->spheres);
    *set = (proxy_set){0};
}
