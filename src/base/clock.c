#include "base/clock.h"

#include <time.h>

static double milliseconds(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

double clock_wall_ms(void) { return milliseconds(CLOCK_MONOTONIC); }
double clock_cpu_ms(void) { return milliseconds(CLOCK_PROCESS_CPUTIME_ID); }

stopwatch stopwatch_start(void) { return (stopwatch){clock_wall_ms(), clock_cpu_ms()}; }

void stopwatch_add(stopwatch *since, double *wall, double *cpu)
{
    stopwatch t = stopwatch_start();
    *wall += t.wall - since->wall;
    *cpu += t.cpu - since->cpu;
    *since = t;
}
