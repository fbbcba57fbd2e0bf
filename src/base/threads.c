#include "base/threads.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdio.h>
#ifdef __GLIBC__
#include <gnu/libc-version.h>
#endif

enum { MAX_THREADS = 256 };

typedef struct loop {
    threads_fn fn;
    void *context;
    size_t count;
    atomic_size_t next;
    atomic_bool failed;
} loop;

typedef struct worker {
    loop *loop;
    int index;
    pthread_t thread;
} worker;

static void *work(void *arg)
{
    worker *w = arg;
    loop *l = w->loop;
    while (!atomic_load(&l->failed)) {
        size_t item = atomic_fetch_add(&l->next, 1);
        if (item >= l->count) break;
        if (!l->fn(l->context, item, w->index)) atomic_store(&l->failed, true);
    }
    return NULL;
}

bool threads_for(int threads, size_t count, threads_fn fn, void *context)
{
    loop l = {.fn = fn, .context = context, .count = count};
    worker workers[MAX_THREADS];
    if (threads > MAX_THREADS) threads = MAX_THREADS;
    if (threads > 0 && (size_t)threads > count) threads = (int)count;
    int started = 1;
    for (int i = 1; i < threads; i++) {
        workers[started] = (worker){.loop = &l, .index = started};
        if (pthread_create(&workers[started].thread, NULL, work, &workers[started]) == 0) started++;
    }
    workers[0] = (worker){.loop = &l, .index = 0};
    work(&workers[0]);
    for (int i = 1; i < started; i++) pthread_join(workers[i].thread, NULL);
    return !atomic_load(&l.failed);
}

bool threads_start_beside_loading(const char *libc_version)
{
    int major, minor;
#ifdef __GLIBC__
    if (!libc_version) libc_version = gnu_get_libc_version();
#endif
    return !libc_version || sscanf(libc_version, "%d.%d", &major, &minor) != 2 || major > 2 || minor >= 34;
}

int threads_default(void)
{
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
    int n = CPU_COUNT(&set);
    return n > 0 ? n : 1;
}
