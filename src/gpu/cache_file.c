#include "gpu/cache_file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/mem.h"

enum { MOST_BYTES = 1 << 24 };

bool cache_own_folder(const char *path)
{
    struct stat st;
    if (mkdir(path, 0700) != 0 && errno != EEXIST) return false;
    if (stat(path, &st) != 0 || !S_ISDIR(st.st_mode)) return false;
    if (st.st_uid != geteuid() || (st.st_mode & 022)) return false;
    return (st.st_mode & 077) == 0 || chmod(path, 0700) == 0;
}

static bool read_all(int fd, char *to, size_t size)
{
    for (size_t done = 0; done < size;) {
        ssize_t n = read(fd, to + done, size - done);
        if (n == 0 || (n < 0 && errno != EINTR)) return false;
        if (n > 0) done += (size_t)n;
    }
    return true;
}

void *cache_read(const char *path, size_t *size)
{
    struct stat st;
    void *bytes = NULL;
    // A pipe would be waited for, and a link may lead anywhere.
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY);
    if (fd < 0) return NULL;
    if (fstat(fd, &st) == 0 && S_ISREG(st.st_mode) && st.st_uid == geteuid() && st.st_size > 0 && st.st_size <= MOST_BYTES) {
        *size = (size_t)st.st_size;
        bytes = mem_zero(*size, 1, NULL);
    }
    bool ok = bytes && read_all(fd, bytes, *size);
    close(fd);
    if (ok) return bytes;
    free(bytes);
    return NULL;
}

static bool write_all(int fd, const char *from, size_t size)
{
    for (size_t done = 0; done < size;) {
        ssize_t n = write(fd, from + done, size - done);
        if (n < 0 && errno != EINTR) return false;
        if (n > 0) done += (size_t)n;
    }
    return true;
}

bool cache_write(const char *path, const void *bytes, size_t size)
{
    char temp[CACHE_PATH + 16];
    int n = snprintf(temp, sizeof temp, "%s.XXXXXX", path);
    int fd = n > 0 && (size_t)n < sizeof temp ? mkstemp(temp) : -1;
    if (fd < 0) return false;
    bool ok = write_all(fd, bytes, size);
    ok = close(fd) == 0 && ok;
    ok = ok && rename(temp, path) == 0;
    if (!ok) unlink(temp);
    return ok;
}

void cache_each(const char *folder, void (*take)(void *context, const char *folder, const char *name), void *context)
{
    DIR *d = opendir(folder);
    for (struct dirent *entry; d && (entry = readdir(d));)
        if (entry->d_name[0] != '.') take(context, folder, entry->d_name);
    if (d) closedir(d);
}

typedef struct aged {
    struct timespec made;
    char *path;
} aged;

typedef struct aged_list {
    bool (*counts)(const char *name);
    aged *list;
    size_t count, capacity;
} aged_list;

static void add_aged(void *context, const char *folder, const char *name)
{
    aged_list *l = context;
    char path[CACHE_PATH];
    struct stat st;
    int n = snprintf(path, sizeof path, "%s/%s", folder, name);
    if (!l->counts(name) || n < 0 || (size_t)n >= sizeof path || lstat(path, &st) != 0) return;
    if (l->count == l->capacity) {
        aged *grown = mem_grow(l->list, 2 * l->capacity + 64, sizeof *grown, NULL);
        if (!grown) return;
        l->list = grown, l->capacity = 2 * l->capacity + 64;
    }
    char *copy = mem_string(path, NULL);
    if (copy) l->list[l->count++] = (aged){st.st_mtim, copy};
}

static int by_age(const void *a, const void *b)
{
    const struct timespec *x = &((const aged *)a)->made, *y = &((const aged *)b)->made;
    if (x->tv_sec != y->tv_sec) return x->tv_sec < y->tv_sec ? -1 : 1;
    return (x->tv_nsec > y->tv_nsec) - (x->tv_nsec < y->tv_nsec);
}

void cache_trim(const char *folder, bool (*counts)(const char *name), size_t most)
{
    aged_list l = {.counts = counts};
    cache_each(folder, add_aged, &l);
    if (l.count > most) {
        qsort(l.list, l.count, sizeof *l.list, by_age);
        for (size_t i = 0; i < l.count - most / 4 * 3; i++) unlink(l.list[i].path);
    }
    for (size_t i = 0; i < l.count; i++) free(l.list[i].path);
    free(l.list);
}
