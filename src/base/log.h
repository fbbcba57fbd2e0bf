// Messages for the user: warnings, and with -v what was concluded.
//
// A log is passed down explicitly; nothing is global. Thread-safe. Warnings are kept (for the report) and each distinct
// `key` is printed once per log, however many frames raise it.
#ifndef SSDO_BASE_LOG_H
#define SSDO_BASE_LOG_H

#include <pthread.h>
#include <stdbool.h>

typedef enum log_level { LOG_QUIET = 0, LOG_WARN = 1, LOG_INFO = 2 } log_level;

typedef struct log {
    log_level level;
    pthread_mutex_t lock;
    char **warnings; // texts of the warnings so far, owned
    char **keys;     // their keys, owned
    int warning_count;
    // Takes every line instead of standard error, the program's name left out; NULL: standard error. Called with the lock held.
    void (*take)(void *context, log_level level, const char *text);
    void *context;
    bool bar; // a progress bar stands on standard error's current line; whoever prints takes it away first
} log_t;

// Takes the current line of a terminal away.
#define LOG_WIPE "\r\033[K"

void log_init(log_t *log, log_level level);
void log_free(log_t *log);

// "ssdo-filter: warning: ..." on stderr unless quiet; once per key.
void log_warn(log_t *log, const char *key, const char *format, ...) __attribute__((format(printf, 3, 4)));
// "ssdo-filter: ..." on stderr, quiet or not: a frame of many that failed.
void log_error(log_t *log, const char *format, ...) __attribute__((format(printf, 2, 3)));
// "ssdo-filter: ..." on stderr with -v only.
void log_info(log_t *log, const char *format, ...) __attribute__((format(printf, 2, 3)));

// Hands out the warnings so far, one after the other, while other threads may add some.
void log_each_warning(log_t *log, void (*take)(void *context, const char *text), void *context);

// Takes a progress bar away, if there is one. The caller holds the lock.
void log_wipe(log_t *log);

#endif
