// A thread that does one task after another: what belongs to a GL context must all happen on one.
#ifndef SSDO_LIBRARY_WORKER_H
#define SSDO_LIBRARY_WORKER_H

#include <pthread.h>
#include <stdbool.h>

typedef struct worker {
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    void (*task)(void *); // under way; NULL: none
    void *argument;
    bool started, ends;
} worker;

void worker_init(worker *w);
// Runs the task on the worker's thread, which the first one starts, and waits for its end. By one caller at a time. False if no
// thread can be had.
bool worker_run(worker *w, void (*task)(void *), void *argument);
void worker_end(worker *w);

#endif
