#include "base/error.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

bool err_set(error *e, error_code code, const char *file, const char *channel, const char *format, ...)
{
    if (!e || e->code != ERR_NONE) return false;
    e->code = code;
    va_list args;
    va_start(args, format);
    vsnprintf(e->message, sizeof e->message, format, args);
    va_end(args);
    snprintf(e->file, sizeof e->file, "%s", file ? file : "");
    snprintf(e->channel, sizeof e->channel, "%s", channel ? channel : "");
    return false;
}

bool err_set_system(error *e, error_code code, int number, const char *file, const char *what)
{
    if (!e || e->code != ERR_NONE) return false;
    e->refused = number;
    return err_set(e, code, file, NULL, "%s: %s", what, strerror(number));
}

void err_format(const error *e, char *buf, unsigned long size)
{
    const char *colon = e->file[0] ? ": " : "";
    if (e->channel[0])
        snprintf(buf, size, "%s%s%s (channel '%s')", e->file, colon, e->message, e->channel);
    else
        snprintf(buf, size, "%s%s%s", e->file, colon, e->message);
}
