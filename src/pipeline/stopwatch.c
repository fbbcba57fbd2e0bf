#include "pipeline/stopwatch.h"

#include <time.h>

static double milliseconds(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

stopwatch stopwatch_start(void) { return (stopwatch){milliseconds(CLOCK_MONOTONIC), milliseconds(CLOCK_PROCESS_CPUTIME_ID)}; }

void stopwatch_add(stopwatch *since, double *wall, double *cpu)
{
    stopwatch t = stopwatch_start();
    *wall += t.wall - since->wall;
    *cpu += t.cpu - since->cpu;
    *since = t;
}
