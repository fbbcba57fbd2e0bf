// Times in milliseconds: wall time from some moment on, and the CPU time of the whole process.
#ifndef SSDO_BASE_CLOCK_H
#define SSDO_BASE_CLOCK_H

double clock_wall_ms(void);
double clock_cpu_ms(void);

typedef struct stopwatch {
    double wall, cpu;
} stopwatch;

stopwatch stopwatch_start(void);
// Adds what has passed since *since, and starts it again.
void stopwatch_add(stopwatch *since, double *wall, double *cpu);

#endif
