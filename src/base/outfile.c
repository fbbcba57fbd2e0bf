#include "base/outfile.h"

#include <dirent.h>
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
#include "base/process.h"

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

// The length of the folder's part of a path, final slash included; 0 for a bare name.
static size_t folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

static char *refuse_look(char *target, const char *path, error *e)
{
    err_set_system(e, ERR_OUTPUT, errno, path, "cannot be looked at");
    free(target);
    return NULL;
}

char *outfile_target(const char *path, error *e)
{
    enum { MOST_LINKS = 40 };
    char *target = realpath(path, NULL), to[PATH_MAX];
    if (target) return target;
    if (errno == ENOMEM) return err_set(e, ERR_MEMORY, path, NULL, "out of memory"), NULL;
    if (errno != ENOENT && errno != ENOTDIR) return refuse_look(NULL, path, e);
    // Links to a file that is not there yet.
    target = mem_string(path, e);
    for (int i = 0; target && i < MOST_LINKS; i++) {
        ssize_t n = readlink(target, to, sizeof to - 1);
        if (n < 0 && errno != EINVAL && errno != ENOENT && errno != ENOTDIR) return refuse_look(target, path, e);
        if (n <= 0) break;
        size_t folder = to[0] == '/' ? 0 : folder_length(target), size = folder + (size_t)n + 1;
        char *next = mem_zero(size, 1, e);
        if (next) snprintf(next, size, "%.*s%.*s", (int)folder, target, (int)n, to);
        free(target);
        target = next;
    }
    return target;
}

static uint64_t random_number(void)
{
    uint64_t r;
    if (getrandom(&r, sizeof r, GRND_NONBLOCK) == (ssize_t)sizeof r) return r;
    struct timespec now; // before the kernel has entropy: O_EXCL still keeps two files apart
    clock_gettime(CLOCK_REALTIME, &now);
    return (uint64_t)now.tv_sec * 1000000007u ^ (uint64_t)now.tv_nsec;
}

// ".NAME.HOST-", which the target's temporary files of this host begin with, without the folder; name and host are cut so that
// the whole stays below NAME_MAX.
static void temp_beginning(const char *target, char *out, size_t size)
{
    char host[64] = "host";
    gethostname(host, sizeof host - 1);
    host[sizeof host - 1] = '\0';
    for (char *p = host; *p; p++)
        if (*p == '/') *p = '_';
    snprintf(out, size, ".%.96s.%s-", target + folder_length(target), host);
}

// FOLDER/BEGINNING PID-TAG-RANDOM.tmp
static char *temp_name(const char *target, const char *beginning, error *e)
{
    size_t folder = folder_length(target), size = folder + 256;
    char *name = mem_zero(size, 1, e);
    if (name)
        snprintf(name, size, "%.*s%s%ld-%016llx-%016llx.tmp", (int)folder, target, beginning, (long)getpid(),
                 (unsigned long long)process_place(), (unsigned long long)random_number());
    return name;
}

// True for what follows the beginning of a temporary file whose process is known to be gone: killed, with no time to clean up.
static bool is_abandoned(const char *rest)
{
    char *end;
    long pid = strtol(rest, &end, 10);
    if (pid < 1 || *end != '-' || strlen(end) != 1 + 16 + 1 + 16 + 4) return false;
    uint64_t tag = strtoull(end + 1, &end, 16);
    bool shape = *end == '-' && strspn(end + 1, "0123456789abcdef") == 16 && strcmp(end + 17, ".tmp") == 0;
    return shape && process_is_gone(pid, tag);
}

static void remove_abandoned(const char *target, const char *beginning)
{
    size_t folder = folder_length(target), length = strlen(beginning);
    char *path = folder ? strndup(target, folder) : strdup(".");
    DIR *d = path ? opendir(path) : NULL;
    for (struct dirent *entry; d && (entry = readdir(d));)
        if (strncmp(entry->d_name, beginning, length) == 0 && is_abandoned(entry->d_name + length))
            unlinkat(dirfd(d), entry->d_name, 0);
    if (d) closedir(d);
    free(path);
}

// A new file takes the rights of the one it replaces.
static bool check_target(const char *path, const char *target, mode_t *mode, error *e)
{
    struct stat st;
    if (stat(target, &st) != 0)
        return errno == ENOENT || errno == ENOTDIR || err_set_system(e, ERR_OUTPUT, errno, path, "cannot be looked at");
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

bool outfile_check_folder(const char *path, error *e)
{
    char folder[PATH_MAX] = ".", *target = outfile_target(path, e);
    if (!target) return false;
    size_t n = folder_length(target);
    if (n && n < sizeof folder) snprintf(folder, sizeof folder, "%.*s", (int)n, target);
    // Of a path that is too long creating the file will say so.
    bool ok = n >= sizeof folder || access(folder, W_OK | X_OK) == 0 || report_folder(path, target, errno, e);
    free(target);
    return ok;
}

void outfile_tidy(const char *path)
{
    char beginning[256], *target = outfile_target(path, NULL);
    if (!target) return;
    temp_beginning(target, beginning, sizeof beginning);
    remove_abandoned(target, beginning);
    free(target);
}

bool outfile_begin(const char *path, outfile *out, error *e)
{
    *out = OUTFILE_NONE;
    mode_t mode = 0;
    char beginning[256];
    out->target = outfile_target(path, e);
    if (!out->target || !check_target(path, out->target, &mode, e)) goto fail;
    temp_beginning(out->target, beginning, sizeof beginning);
    remove_abandoned(out->target, beginning);
    for (int i = 0; i < ATTEMPTS && out->fd < 0; i++) {
        free(out->temp);
        out->temp = temp_name(out->target, beginning, e);
        if (!out->temp) goto fail;
        track(out->temp); // before it is there: a signal may come at any moment
        out->fd = open(out->temp, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (out->fd >= 0) break;
        int code = errno;
        untrack(out->temp);
        errno = code;
        if (code != EEXIST) break;
    }
    if (out->fd < 0) {
        report_folder(path, out->target, errno, e);
        goto fail;
    }
    if (mode) (void)!fchmod(out->fd, mode);
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

bool outfile_put(outfile *out, const void *bytes, size_t size, uint64_t offset)
{
    const char *from = bytes;
    for (size_t done = 0; done < size && !out->code;) {
        ssize_t n = pwrite(out->fd, from + done, size - done, (off_t)(offset + done));
        if (n < 0 && errno == EINTR) continue;
        if (n > 0)
            done += (size_t)n;
        else
            out->code = n < 0 ? errno : ENOSPC;
    }
    if (offset + size > out->end) out->end = offset + size;
    return !out->code;
}

// A file system may drop bytes that it took, and say so late or never.
static int check_length(const outfile *out)
{
    struct stat st;
    if (fstat(out->fd, &st) != 0) return errno;
    return (uint64_t)st.st_size == out->end ? 0 : EIO;
}

bool outfile_commit(outfile *out, error *e)
{
    int code = out->code;
    if (!code && fsync(out->fd) != 0 && errno != EINVAL && errno != EROFS) code = errno;
    if (!code) code = check_length(out);
    if (close(out->fd) != 0 && !code) code = errno; // NFS reports a full disk here
    out->fd = -1;
    if (!code && rename(out->temp, out->target) != 0) code = errno;
    if (code)
        err_set(e, ERR_OUTPUT, out->target, NULL, "cannot be written: %s; free some space or choose another output",
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

bool outfile_write(const char *path, const void *bytes, size_t size, error *e)
{
    outfile out = OUTFILE_NONE;
    if (!outfile_begin(path, &out, e)) return false;
    outfile_put(&out, bytes, size, 0);
    return outfile_commit(&out, e);
}
