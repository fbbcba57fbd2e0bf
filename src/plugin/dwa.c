#include "plugin/dwa.h"

#include "plugin/module.h"

static const module dwa = {"ssdo-dwa.so", "OpenEXR"};

static module_call function(const char *name, const char *path, error *e)
{
    return module_function(&dwa, name, "reading DWAA or DWAB compression (ZIP needs no module)", ERR_INPUT, path, e);
}

bool dwa_module_open(const char *path, dwa_module *out, error *e)
{
    *out = (dwa_module){.open = (dwa_open_fn)function("ssdo_dwa_open", path, e)};
    if (out->open) out->decode = (dwa_decode_fn)function("ssdo_dwa_decode", path, e);
    if (out->decode) out->close = (dwa_close_fn)function("ssdo_dwa_close", path, e);
    return out->close != NULL;
}
