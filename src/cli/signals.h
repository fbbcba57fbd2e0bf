// How the process ends when it is asked to.
//
// SIGINT, SIGTERM and SIGHUP (unless the caller ignores it, as nohup does) ask for an end: frames are dropped, but for one that
// is written within half a second. What takes longer than that, a driver that compiles or a slow disk, is cut: temporary files
// are removed and the process ends with 128 + the signal's number, so that a farm is answered within a second whatever is going
// on. A second SIGINT ends the process at once; a farm repeats SIGTERM and means the same. Writing beyond `ulimit -f` or into a
// closed pipe is an error where it happens, not a signal.
#ifndef SSDO_CLI_SIGNALS_H
#define SSDO_CLI_SIGNALS_H

// To be called once, before the first thread starts. What is returned points to 0 and, once the process shall end, to the
// signal's number.
const volatile int *signals_catch(void);

#endif
