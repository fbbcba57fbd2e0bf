// measure ROUNDS NAME1 'COMMAND1' NAME2 'COMMAND2' ...: runs the commands in turn, ROUNDS times, and prints for each its median
// CPU and wall milliseconds, the spread of the CPU (largest less smallest, in per cent of the median) and the peak memory in MiB.
// Commands run in sh. In turn, because this kind of machine drifts: what one round suffers, all suffer.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/sort.h"

enum { MOST = 32, MOST_ROUNDS = 99 };

typedef struct series {
    double cpu[MOST_ROUNDS], wall[MOST_ROUNDS];
    long peak;
} series;

static double seconds(struct timeval t) { return (double)t.tv_sec + 1e-6 * (double)t.tv_usec; }

static int run(const char *command, double *cpu, double *wall, long *peak)
{
    struct rusage u;
    int status;
    double begun = clock_wall_ms();
    pid_t pid = fork();
    if (pid == 0) {
        execl("/bin/sh", "sh", "-c", command, (char *)NULL);
        _exit(127);
    }
    if (pid < 0 || wait4(pid, &status, 0, &u) != pid) return -1;
    *wall = clock_wall_ms() - begun;
    *cpu = 1e3 * (seconds(u.ru_utime) + seconds(u.ru_stime));
    if (u.ru_maxrss > *peak) *peak = u.ru_maxrss;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

int main(int argc, char **argv)
{
    static series all[MOST];
    int rounds = argc > 3 ? atoi(argv[1]) : 0, count = (argc - 2) / 2;
    if (rounds < 1 || rounds > MOST_ROUNDS || count > MOST || argc % 2) return 2;
    for (int r = 0; r < rounds; r++)
        for (int i = 0; i < count; i++)
            if (run(argv[3 + 2 * i], &all[i].cpu[r], &all[i].wall[r], &all[i].peak) != 0) {
                fprintf(stderr, "measure: '%s' failed\n", argv[3 + 2 * i]);
                return 1;
            }
    for (int i = 0; i < count; i++) {
        sort_doubles(all[i].cpu, (size_t)rounds);
        sort_doubles(all[i].wall, (size_t)rounds);
        double cpu = all[i].cpu[rounds / 2];
        printf("%s\t%.0f\t%.0f\t%.0f\t%ld\n", argv[2 + 2 * i], cpu, all[i].wall[rounds / 2],
               cpu > 0 ? 100.0 * (all[i].cpu[rounds - 1] - all[i].cpu[0]) / cpu : 0.0, all[i].peak / 1024);
    }
    return 0;
}
