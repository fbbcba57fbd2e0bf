#include "base/log.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"

void log_init(log_t *log, log_level level)
{
    *log = (log_t){.level = level};
    pthread_mutex_init(&log->lock, NULL);
}

void log_free(log_t *log)
{
    for (int i = 0; i < log->warning_count; i++) {
        free(log->warnings[i]);
        free(log->keys[i]);
    }
    free(log->warnings);
    free(log->keys);
    pthread_mutex_destroy(&log->lock);
}

// Keeps the warning; false if its key is known. A warning that cannot be kept for want of memory is still printed.
static bool remember(log_t *log, const char *key, const char *text)
{
    for (int i = 0; i < log->warning_count; i++)
        if (strcmp(log->keys[i], key) == 0) return false;
    size_t n = (size_t)log->warning_count + 1;
    char **w = realloc(log->warnings, n * sizeof *w);
    if (w) log->warnings = w;
    char **k = realloc(log->keys, n * sizeof *k);
    if (k) log->keys = k;
    char *wt = strdup(text), *kt = strdup(key);
    if (!w || !k || !wt || !kt) {
        free(wt);
        free(kt);
        return true;
    }
    log->warnings[log->warning_count] = wt;
    log->keys[log->warning_count++] = kt;
    return true;
}

void log_each_warning(log_t *log, void (*take)(void *context, const char *text), void *context)
{
    pthread_mutex_lock(&log->lock);
    for (int i = 0; i < log->warning_count; i++) take(context, log->warnings[i]);
    pthread_mutex_unlock(&log->lock);
}

void log_wipe(log_t *log)
{
    if (log->bar) fputs(LOG_WIPE, stderr);
    log->bar = false;
}

static void print_line(log_t *log, log_level level, const char *kind, char *text)
{
    text_one_line(text);
    if (log->take) {
        log->take(log->context, level, text);
        return;
    }
    log_wipe(log);
    fprintf(stderr, "ssdo-filter: %s%s\n", kind, text);
}

void log_warn(log_t *log, const char *key, const char *format, ...)
{
    if (!log) return;
    char text[1024];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    pthread_mutex_lock(&log->lock);
    if (remember(log, key, text) && log->level >= LOG_WARN) print_line(log, LOG_WARN, "warning: ", text);
    pthread_mutex_unlock(&log->lock);
}

static void say(log_t *log, log_level level, const char *format, va_list args)
{
    char text[2048];
    vsnprintf(text, sizeof text, format, args);
    pthread_mutex_lock(&log->lock);
    print_line(log, level, "", text);
    pthread_mutex_unlock(&log->lock);
}

void log_error(log_t *log, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    say(log, LOG_WARN, format, args);
    va_end(args);
}

void log_info(log_t *log, const char *format, ...)
{
    if (!log || log->level < LOG_INFO) return;
    va_list args;
    va_start(args, format);
    say(log, LOG_INFO, format, args);
    va_end(args);
}
