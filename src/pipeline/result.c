#include "pipeline/result.h"

void result_lap(frame_result *r, stage s, stopwatch *since) { stopwatch_add(since, &r->wall_ms[s], &r->cpu_ms[s]); }
