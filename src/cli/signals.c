#include "cli/signals.h"

#include <signal.h>
#include <stddef.h>
#include <sys/time.h>
#include <unistd.h>

#include "base/outfile.h"

enum { GRACE = 250 * 1000 };     // microseconds
static volatile int stop_signal; // a handler is handed nothing

// For signal handlers.
static void end_at_once(int number)
{
    outfile_remove_all();
    _exit(128 + number);
}

static void on_signal(int number)
{
    const struct itimerval grace = {.it_value = {.tv_usec = GRACE}};
    if (stop_signal && number == SIGINT) end_at_once(number);
    if (stop_signal) return; // the first one's time runs
    stop_signal = number;
    setitimer(ITIMER_REAL, &grace, NULL);
}

static void on_grace_over(int number)
{
    static const char text[] =
        "ssdo-filter: stopped in the middle of a frame, of which nothing is left; the same command makes it\n";
    (void)number;
    (void)!write(STDERR_FILENO, text, sizeof text - 1);
    end_at_once(stop_signal);
}

static void catch_signal(int number, void (*handler)(int))
{
    struct sigaction a = {.sa_handler = handler}; // no SA_RESTART: a call that waits ends
    sigemptyset(&a.sa_mask);
    sigaction(number, &a, NULL);
}

const volatile int *signals_catch(void)
{
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN); // ulimit -f: writing fails, as on a full disk
    catch_signal(SIGALRM, on_grace_over);
    catch_signal(SIGINT, on_signal);
    catch_signal(SIGTERM, on_signal);
    struct sigaction hangup;
    if (sigaction(SIGHUP, NULL, &hangup) == 0 && hangup.sa_handler != SIG_IGN) catch_signal(SIGHUP, on_signal); // nohup
    return &stop_signal;
}
