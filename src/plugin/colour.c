#include "plugin/colour.h"

#include <stdlib.h>
#include <string.h>

#include "base/infile.h"
#include "plugin/colour_abi.h"
#include "plugin/module.h"

static const module colour = {"ssdo-colour.so", "OpenColorIO"};

const char *colour_config(const char *config)
{
    const char *path = config ? config : getenv("OCIO");
    return path && *path ? path : NULL;
}

// OpenColorIO knows configs without a file: ocio://default.
static bool check_config(const char *path, error *e)
{
    return strstr(path, "://") || infile_check(path, (infile_kind){"the OpenColorIO config", ERR_INPUT}, e);
}

bool colour_to_scene_linear(const char *config, const char *from, float *rgb, size_t n, error *e)
{
    char message[MODULE_MESSAGE] = "";
    const char *path = colour_config(config);
    if (!path)
        return err_set(e, ERR_USAGE, NULL, NULL,
                       "colour space '%s' needs an OpenColorIO config; name one with --ocio or in $OCIO", from);
    if (!check_config(path, e)) return false;
    colour_to_linear_fn convert =
        (colour_to_linear_fn)module_function(&colour, "ssdo_colour_to_linear", "converting colours", ERR_INPUT, path, e);
    if (!convert) return false;
    if (convert(path, from, rgb, n, message, sizeof message)) return true;
    return err_set(e, ERR_INPUT, path, NULL, "%s", message);
}

bool colour_to_display(const char *config, const char *display, const char *view, float *rgb, size_t n, error *e)
{
    char message[MODULE_MESSAGE] = "";
    const char *path = colour_config(config);
    if (!path)
        return err_set(e, ERR_USAGE, NULL, NULL,
                       "a display and view for previews need an OpenColorIO config; name one with --ocio or in $OCIO");
    if (!check_config(path, e)) return false;
    colour_to_display_fn convert =
        (colour_to_display_fn)module_function(&colour, "ssdo_colour_to_display", "converting colours", ERR_INPUT, path, e);
    if (!convert) return false;
    if (convert(path, display, view, rgb, n, message, sizeof message)) return true;
    return err_set(e, ERR_INPUT, path, NULL, "%s", message);
}

bool colour_identity(const char *config, const char *from, const char *display, const char *view, char text[COLOUR_IDENTITY],
                     error *e)
{
    char message[MODULE_MESSAGE] = "";
    const char *path = colour_config(config);
    if (!path) return err_set(e, ERR_USAGE, NULL, NULL, "no OpenColorIO config; name one with --ocio or in $OCIO");
    if (!check_config(path, e)) return false;
    colour_identity_fn identity =
        (colour_identity_fn)module_function(&colour, "ssdo_colour_identity", "converting colours", ERR_INPUT, path, e);
    if (!identity) return false;
    if (identity(path, from, display, view, text, COLOUR_IDENTITY, message, sizeof message)) return true;
    return err_set(e, ERR_INPUT, path, NULL, "%s", message);
}
