#include "library/worker.h"

#include <signal.h>
#include <stddef.h>

void worker_init(worker *w)
{
    *w = (worker){0};
    pthread_mutex_init(&w->lock, NULL);
    pthread_cond_init(&w->changed, NULL);
}

static void *work(void *of)
{
    worker *w = of;
    pthread_mutex_lock(&w->lock);
    while (!w->ends) {
        if (w->task) {
            pthread_mutex_unlock(&w->lock);
            w->task(w->argument);
            pthread_mutex_lock(&w->lock);
            w->task = NULL;
            pthread_cond_broadcast(&w->changed);
        } else {
            pthread_cond_wait(&w->changed, &w->lock);
        }
    }
    pthread_mutex_unlock(&w->lock);
    return NULL;
}

// The host's signals are for the host's threads.
static bool start(worker *w)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    w->started = pthread_create(&w->thread, NULL, work, w) == 0;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return w->started;
}

bool worker_run(worker *w, void (*task)(void *), void *argument)
{
    if (!w->started && !start(w)) return false;
    pthread_mutex_lock(&w->lock);
    w->task = task, w->argument = argument;
    pthread_cond_broadcast(&w->changed);
    while (w->task) pthread_cond_wait(&w->changed, &w->lock);
    pthread_mutex_unlock(&w->lock);
    return true;
}

void worker_end(worker *w)
{
    if (w->started) {
        pthread_mutex_lock(&w->lock);
        w->ends = true;
        pthread_cond_broadcast(&w->changed);
        pthread_mutex_unlock(&w->lock);
        pthread_join(w->thread, NULL);
    }
    pthread_mutex_destroy(&w->lock);
    pthread_cond_destroy(&w->changed);
}
