#include "base/outfile.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/mem.h"

enum { ATTEMPTS = 16 };

// The temporary files there are. A signal handler is handed nothing, so this is the one thing of the program that is global.
enum { FREE, CHANGING, LIVE };
static struct tracked {
    atomic_int state;
    char path[PATH_MAX];
} tracked[OUTFILE_TRACKED];

static void track(const char *path)
{
    size_t n = strlen(path);
    for (int i = 0; i < OUTFILE_TRACKED && n < PATH_MAX; i++) {
        int expected = FREE;
        if (!atomic_compare_exchange_strong(&tracked[i].state, &expected, CHANGING)) continue;
        memcpy(tracked[i].path, path, n + 1);
        atomic_store(&tracked[i].state, LIVE);
        return;
    }
}

static void untrack(const char *path)
{
    for (int i = 0; i < OUTFILE_TRACKED; i++)
        if (atomic_load(&tracked[i].state) == LIVE && strcmp(tracked[i].path, path) == 0) atomic_store(&tracked[i].state, FREE);
}

void outfile_remove_all(void)
{
    for (int i = 0; i < OUTFILE_TRACKED; i++)
        if (atomic_load(&tracked[i].state) == LIVE) unlink(tracked[i].path);
}

// The path the file will really have: a symbolic link is followed, so that it is not replaced by a plain file.
static char *resolve_target(const char *path, error *e)
{
    char *real = realpath(path, NULL);
    if (!real) return mem_string(path, e);
    char *copy = mem_string(real, e);
    free(real);
    return copy;
}

// The length of the folder's part of a path, final slash included; 0 for a bare name.
static size_t folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

static uint64_t random_number(void)
{
    uint64_t r;
    if (getrandom(&r, sizeof r, GRND_NONBLOCK) == (ssize_t)sizeof r) return r;
    struct timespec now; // before the kernel has entropy: O_EXCL still keeps two files apart
    clock_gettime(CLOCK_REALTIME, &now);
    return (uint64_t)now.tv_sec * 1000000007u ^ (uint64_t)now.tv_nsec;
}

// ".NAME.HOST-PID-RANDOM.tmp" beside the target; name and host are cut so that the whole stays below NAME_MAX.
static char *temp_name(const char *target, error *e)
{
    char host[64] = "host";
    gethostname(host, sizeof host - 1);
    host[sizeof host - 1] = '\0';
    for (char *p = host; *p; p++)
        if (*p == '/') *p = '_';
    size_t folder = folder_length(target), size = folder + 256;
    char *name = mem_zero(size, 1, e);
    if (name)
        snprintf(name, size, "%.*s.%.96s.%s-%ld-%016llx.tmp", (int)folder, target, target + folder, host, (long)getpid(),
                 (unsigned long long)random_number());
    return name;
}

// A new file takes the rights of the one it replaces.
static bool check_target(const char *path, const char *target, mode_t *mode, error *e)
{
    struct stat st;
    if (stat(target, &st) != 0) return true;
    if (S_ISDIR(st.st_mode)) return err_set(e, ERR_OUTPUT, path, NULL, "the output is a folder; name a file in it");
    if (!S_ISREG(st.st_mode))
        return err_set(e, ERR_OUTPUT, path, NULL, "the output is not a regular file, and a file is only ever replaced whole");
    *mode = st.st_mode & 07777;
    return true;
}

static bool report_folder(const char *path, const char *target, int code, error *e)
{
    size_t n = folder_length(target);
    return err_set(e, ERR_OUTPUT, path, NULL, "cannot create a file in the folder '%.*s': %s; create it or choose another output",
                   n ? (int)n : 1, n ? target : ".", strerror(code));
}

bool outfile_begin(const char *path, outfile *out, error *e)
{
    *out = OUTFILE_NONE;
    mode_t mode = 0;
    out->target = resolve_target(path, e);
    if (!out->target || !check_target(path, out->target, &mode, e)) goto fail;
    for (int i = 0; i < ATTEMPTS && out->fd < 0; i++) {
        free(out->temp);
        out->temp = temp_name(out->target, e);
        if (!out->temp) goto fail;
        out->fd = open(out->temp, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (out->fd < 0 && errno != EEXIST) break;
    }
    if (out->fd < 0) {
        report_folder(path, out->target, errno, e);
        goto fail;
    }
    if (mode) (void)!fchmod(out->fd, mode);
    track(out->temp);
    return true;

fail:
    free(out->temp);
    free(out->target);
    *out = OUTFILE_NONE;
    return false;
}

// Makes the rename itself durable. Some file systems cannot flush a folder; the file is in place nevertheless.
static void sync_folder(const char *target)
{
    size_t n = folder_length(target);
    char *folder = n ? strndup(target, n) : strdup(".");
    int fd = folder ? open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
    if (fd >= 0) {
        (void)!fsync(fd);
        close(fd);
    }
    free(folder);
}

bool outfile_commit(outfile *out, error *e)
{
    int code = 0;
    if (fsync(out->fd) != 0 && errno != EINVAL && errno != EROFS) code = errno;
    if (close(out->fd) != 0 && !code) code = errno; // NFS reports a full disk here
    out->fd = -1;
    if (!code && rename(out->temp, out->target) != 0) code = errno;
    if (code)
        err_set(e, ERR_OUTPUT, out->target, NULL, "cannot finish the file: %s; free some space or choose another output",
                strerror(code));
    else {
        sync_folder(out->target);
        untrack(out->temp);
        free(out->temp);
        out->temp = NULL; // nothing to remove
    }
    outfile_abort(out);
    return code == 0;
}

void outfile_abort(outfile *out)
{
    if (out->fd >= 0) close(out->fd);
    if (out->temp) {
        unlink(out->temp);
        untrack(out->temp);
    }
    free(out->temp);
    free(out->target);
    *out = OUTFILE_NONE;
}
