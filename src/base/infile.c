#include "base/infile.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/mem.h"

static bool refuse(const char *path, infile_kind k, const char *verb, const char *detail, error *e)
{
    return err_set(e, k.code, path, NULL, "%s%s%s%s", k.what ? k.what : "", k.what ? " " : "", verb, detail);
}

static bool refuse_call(const char *path, infile_kind k, const char *verb, int code, error *e)
{
    char what[128];
    snprintf(what, sizeof what, "%s%s%s", k.what ? k.what : "", k.what ? " " : "", verb);
    return err_set_system(e, k.code, code, path, what);
}

static bool refuse_errno(const char *path, infile_kind k, int code, error *e)
{
    if (code == ENOENT || code == ENOTDIR) return refuse(path, k, "does not exist; check the name", "", e);
    return refuse_call(path, k, "cannot be opened", code, e);
}

static const char *kind_of(mode_t mode)
{
    if (S_ISDIR(mode)) return "a folder";
    if (S_ISFIFO(mode)) return "a pipe";
    if (S_ISSOCK(mode)) return "a socket";
    return "a device";
}

static bool is_regular(const char *path, infile_kind k, const struct stat *s, error *e)
{
    if (S_ISREG(s->st_mode)) return true;
    char detail[80];
    strcpy(detail, kind_of(s->st_mode));
    strcat(detail, "; name a file that holds the data");
    return refuse(path, k, "is not a regular file but ", detail, e);
}

int infile_open(const char *path, infile_kind k, size_t *size, error *e)
{
    struct stat s;
    if (stat(path, &s) != 0) return refuse_errno(path, k, errno, e), -1;
    if (!is_regular(path, k, &s, e)) return -1;
    // Without waiting, should a pipe have taken the file's place since.
    int fd = open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (fd < 0) return refuse_errno(path, k, errno, e), -1;
    bool ok = fstat(fd, &s) == 0 ? is_regular(path, k, &s, e) : refuse_errno(path, k, errno, e);
    if (!ok) {
        close(fd);
        return -1;
    }
    if (size) *size = (size_t)s.st_size;
    return fd;
}

bool infile_check(const char *path, infile_kind k, error *e)
{
    int fd = infile_open(path, k, NULL, e);
    if (fd >= 0) close(fd);
    return fd >= 0;
}

bool infile_exists(const char *path, infile_kind k, bool *there, error *e)
{
    struct stat s;
    bool found = stat(path, &s) == 0;
    if (!found && errno != ENOENT && errno != ENOTDIR) return refuse_errno(path, k, errno, e);
    *there = found;
    return true;
}

size_t infile_read_at(int fd, void *to, size_t n, size_t offset)
{
    size_t done = 0;
    errno = 0;
    while (done < n) {
        ssize_t got = pread(fd, (char *)to + done, n - done, (off_t)(offset + done));
        if (got < 0 && errno == EINTR) {
            errno = 0;
            continue;
        }
        if (got <= 0) break;
        done += (size_t)got;
    }
    return done;
}

char *infile_text(const char *path, infile_kind k, size_t most, size_t *length, error *e)
{
    size_t size = 0;
    char *text = NULL;
    int fd = infile_open(path, k, &size, e);
    if (fd < 0) return NULL;
    if (size > most) {
        refuse(path, k, "is larger than such a file is; check the name", "", e);
    } else if ((text = mem_grow(NULL, size + 1, 1, e)) && infile_read_at(fd, text, size, 0) != size) {
        if (errno)
            refuse_call(path, k, "cannot be read", errno, e);
        else
            refuse(path, k, "cannot be read: it became shorter meanwhile", "", e);
        free(text);
        text = NULL;
    }
    close(fd);
    if (text) text[size] = 0;
    if (text && length) *length = size;
    return text;
}
