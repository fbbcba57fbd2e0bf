// Wall time and the CPU time of the whole process, in milliseconds.
#ifndef SSDO_PIPELINE_STOPWATCH_H
#define SSDO_PIPELINE_STOPWATCH_H

typedef struct stopwatch {
    double wall, cpu;
} stopwatch;

stopwatch stopwatch_start(void);
// Adds what has passed since *since, and starts it again.
void stopwatch_add(stopwatch *since, double *wall, double *cpu);

#endif
