// LD_PRELOAD library: the n-th call of one kind fails, once. For tests/hard/table.sh.
//
//   SSDO_FAULT=KIND      open read write fsync rename close mmap allocate mkdir unlink stat folder thread egl; all: counts of
//   each SSDO_FAULT_AT=N      which of them fails, from 1 on; 0 or none: no one SSDO_FAULT_COUNT=F   where the number of calls of
//   that kind is put at the end; of all: a line "kind number" for each SSDO_FAULT_WHO=W     program: calls of the program, its
//   modules and the libraries that read and write for it; driver: all others
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

static const char *kind, *who, *count_file;
static long at;
static atomic_long count;
static const char *const kinds[] = {"open",     "read",  "write",  "fsync", "rename", "close",  "mmap",
                                    "allocate", "mkdir", "unlink", "stat",  "folder", "thread", "egl"};
enum { KINDS = sizeof kinds / sizeof *kinds };
static atomic_long counts[KINDS];
static pid_t process;

__attribute__((constructor)) static void begin(void)
{
    const char *n = getenv("SSDO_FAULT_AT");
    kind = getenv("SSDO_FAULT");
    who = getenv("SSDO_FAULT_WHO");
    count_file = getenv("SSDO_FAULT_COUNT");
    at = n ? atol(n) : 0;
    process = getpid();
}

__attribute__((destructor)) static void end(void)
{
    if (!count_file || getpid() != process) return;
    bool all = kind && strcmp(kind, "all") == 0;
    kind = NULL;
    FILE *f = fopen(count_file, "w");
    for (int i = 0; f && all && i < KINDS; i++) fprintf(f, "%s %ld\n", kinds[i], atomic_load(&counts[i]));
    if (f && !all) fprintf(f, "%ld\n", atomic_load(&count));
    if (f) fclose(f);
}

// Whose call it is, by the object that the return address lies in.
static bool is_program(const void *caller)
{
    static const char *const ours[] = {"ssdo-", "libOpenEXR", "libOpenImageIO", "libOpenColorIO", "libjson-c", "libpng"};
    Dl_info info;
    if (!dladdr(caller, &info) || !info.dli_fname) return false;
    const char *slash = strrchr(info.dli_fname, '/'), *name = slash ? slash + 1 : info.dli_fname;
    for (size_t i = 0; i < sizeof ours / sizeof *ours; i++)
        if (strncmp(name, ours[i], strlen(ours[i])) == 0) return true;
    return false;
}

static bool fails(const char *what, const void *caller)
{
    bool all = kind && strcmp(kind, "all") == 0;
    if (!kind || (!all && strcmp(kind, what) != 0)) return false;
    if (caller && is_program(caller) != (!who || strcmp(who, "driver") != 0)) return false;
    for (int i = 0; all && i < KINDS; i++)
        if (strcmp(kinds[i], what) == 0) atomic_fetch_add(&counts[i], 1);
    return !all && atomic_fetch_add(&count, 1) + 1 == at;
}

#define CALLER __builtin_return_address(0)
#define REAL(name, type) ((type)dlsym_real(RTLD_NEXT, name))

static void *dlsym_real(void *handle, const char *name)
{
    static void *(*real)(void *, const char *);
    if (!real) real = (void *(*)(void *, const char *))dlvsym(RTLD_NEXT, "dlsym", "GLIBC_2.2.5");
    return real(handle, name);
}

static int fail(int code)
{
    errno = code;
    return -1;
}

static int open_with(const char *name, const char *path, int flags, mode_t mode)
{
    return REAL(name, int (*)(const char *, int, ...))(path, flags, mode);
}

#define MODE_OF(flags)                                                                                                           \
    mode_t mode = 0;                                                                                                             \
    if ((flags) & (O_CREAT | O_TMPFILE)) {                                                                                       \
        va_list args;                                                                                                            \
        va_start(args, flags);                                                                                                   \
        mode = va_arg(args, mode_t);                                                                                             \
        va_end(args);                                                                                                            \
    }

int open(const char *path, int flags, ...)
{
    MODE_OF(flags)
    return fails("open", CALLER) ? fail(EIO) : open_with("open", path, flags, mode);
}
int open64(const char *path, int flags, ...)
{
    MODE_OF(flags)
    return fails("open", CALLER) ? fail(EIO) : open_with("open64", path, flags, mode);
}
int mkstemp(char *name) { return fails("open", CALLER) ? fail(EIO) : REAL("mkstemp", int (*)(char *))(name); }
int openat(int folder, const char *path, int flags, ...)
{
    MODE_OF(flags)
    return fails("open", CALLER) ? fail(EIO) : REAL("openat", int (*)(int, const char *, int, ...))(folder, path, flags, mode);
}
FILE *fopen(const char *path, const char *how)
{
    if (fails("open", CALLER)) return fail(EIO), NULL;
    return REAL("fopen", FILE * (*)(const char *, const char *))(path, how);
}
FILE *fopen64(const char *path, const char *how)
{
    if (fails("open", CALLER)) return fail(EIO), NULL;
    return REAL("fopen64", FILE * (*)(const char *, const char *))(path, how);
}
DIR *opendir(const char *path)
{
    if (fails("folder", CALLER)) return fail(EIO), NULL;
    return REAL("opendir", DIR * (*)(const char *))(path);
}

struct dirent *readdir(DIR *d)
{
    if (fails("folder", CALLER)) return fail(EIO), NULL;
    return REAL("readdir", struct dirent * (*)(DIR *))(d);
}

ssize_t read(int fd, void *to, size_t n)
{
    return fails("read", CALLER) ? fail(EIO) : REAL("read", ssize_t(*)(int, void *, size_t))(fd, to, n);
}
ssize_t pread(int fd, void *to, size_t n, off_t from)
{
    return fails("read", CALLER) ? fail(EIO) : REAL("pread", ssize_t(*)(int, void *, size_t, off_t))(fd, to, n, from);
}
ssize_t pread64(int fd, void *to, size_t n, off_t from)
{
    return fails("read", CALLER) ? fail(EIO) : REAL("pread64", ssize_t(*)(int, void *, size_t, off_t))(fd, to, n, from);
}
size_t fread(void *to, size_t size, size_t n, FILE *f)
{
    if (fails("read", CALLER)) return fail(EIO), 0;
    return REAL("fread", size_t(*)(void *, size_t, size_t, FILE *))(to, size, n, f);
}

// Standard output and error are not the files of the frame.
static bool is_file(int fd) { return fd > STDERR_FILENO; }

ssize_t write(int fd, const void *from, size_t n)
{
    bool failed = is_file(fd) && fails("write", CALLER);
    return failed ? fail(ENOSPC) : REAL("write", ssize_t(*)(int, const void *, size_t))(fd, from, n);
}
ssize_t pwrite(int fd, const void *from, size_t n, off_t to)
{
    return fails("write", CALLER) ? fail(ENOSPC) : REAL("pwrite", ssize_t(*)(int, const void *, size_t, off_t))(fd, from, n, to);
}
ssize_t pwrite64(int fd, const void *from, size_t n, off_t to)
{
    return fails("write", CALLER) ? fail(ENOSPC)
                                  : REAL("pwrite64", ssize_t(*)(int, const void *, size_t, off_t))(fd, from, n, to);
}
size_t fwrite(const void *from, size_t size, size_t n, FILE *f)
{
    if (is_file(fileno(f)) && fails("write", CALLER)) return fail(ENOSPC), 0;
    return REAL("fwrite", size_t(*)(const void *, size_t, size_t, FILE *))(from, size, n, f);
}
int fsync(int fd) { return fails("fsync", CALLER) ? fail(EIO) : REAL("fsync", int (*)(int))(fd); }
int rename(const char *a, const char *b)
{
    return fails("rename", CALLER) ? fail(EIO) : REAL("rename", int (*)(const char *, const char *))(a, b);
}
int close(int fd)
{
    int result = REAL("close", int (*)(int))(fd); // the descriptor is gone whatever is said
    return fails("close", CALLER) ? fail(EIO) : result;
}
int fclose(FILE *f)
{
    int result = REAL("fclose", int (*)(FILE *))(f);
    return fails("close", CALLER) ? fail(EIO) : result;
}
void *mmap(void *a, size_t n, int protection, int flags, int fd, off_t from)
{
    if (fails("mmap", CALLER)) return fail(ENOMEM), MAP_FAILED;
    return REAL("mmap", void *(*)(void *, size_t, int, int, int, off_t))(a, n, protection, flags, fd, from);
}
void *mmap64(void *a, size_t n, int protection, int flags, int fd, off_t from)
{
    if (fails("mmap", CALLER)) return fail(ENOMEM), MAP_FAILED;
    return REAL("mmap64", void *(*)(void *, size_t, int, int, int, off_t))(a, n, protection, flags, fd, from);
}
int posix_fallocate(int fd, off_t from, off_t n)
{
    return fails("allocate", CALLER) ? ENOSPC : REAL("posix_fallocate", int (*)(int, off_t, off_t))(fd, from, n);
}
int fallocate(int fd, int mode, off_t from, off_t n)
{
    return fails("allocate", CALLER) ? fail(ENOSPC) : REAL("fallocate", int (*)(int, int, off_t, off_t))(fd, mode, from, n);
}
int ftruncate(int fd, off_t n)
{
    return fails("allocate", CALLER) ? fail(ENOSPC) : REAL("ftruncate", int (*)(int, off_t))(fd, n);
}
int mkdir(const char *path, mode_t mode)
{
    return fails("mkdir", CALLER) ? fail(EACCES) : REAL("mkdir", int (*)(const char *, mode_t))(path, mode);
}
int unlink(const char *path) { return fails("unlink", CALLER) ? fail(EACCES) : REAL("unlink", int (*)(const char *))(path); }
int unlinkat(int folder, const char *path, int flags)
{
    return fails("unlink", CALLER) ? fail(EACCES) : REAL("unlinkat", int (*)(int, const char *, int))(folder, path, flags);
}
int stat(const char *path, struct stat *s)
{
    return fails("stat", CALLER) ? fail(EIO) : REAL("stat", int (*)(const char *, struct stat *))(path, s);
}
int lstat(const char *path, struct stat *s)
{
    return fails("stat", CALLER) ? fail(EIO) : REAL("lstat", int (*)(const char *, struct stat *))(path, s);
}
int fstat(int fd, struct stat *s)
{
    return fails("stat", CALLER) ? fail(EIO) : REAL("fstat", int (*)(int, struct stat *))(fd, s);
}
int fstatat(int folder, const char *path, struct stat *s, int flags)
{
    if (fails("stat", CALLER)) return fail(EIO);
    return REAL("fstatat", int (*)(int, const char *, struct stat *, int))(folder, path, s, flags);
}
int stat64(const char *path, struct stat64 *s)
{
    return fails("stat", CALLER) ? fail(EIO) : REAL("stat64", int (*)(const char *, struct stat64 *))(path, s);
}
int fstat64(int fd, struct stat64 *s)
{
    return fails("stat", CALLER) ? fail(EIO) : REAL("fstat64", int (*)(int, struct stat64 *))(fd, s);
}
int statvfs(const char *path, struct statvfs *s)
{
    return fails("stat", CALLER) ? fail(EIO) : REAL("statvfs", int (*)(const char *, struct statvfs *))(path, s);
}
int faccessat(int folder, const char *path, int how, int flags)
{
    if (fails("stat", CALLER)) return fail(EIO);
    return REAL("faccessat", int (*)(int, const char *, int, int))(folder, path, how, flags);
}
char *realpath(const char *path, char *to)
{
    if (fails("stat", CALLER)) return fail(EIO), NULL;
    return ((char *(*)(const char *, char *))dlvsym(RTLD_NEXT, "realpath", "GLIBC_2.3"))(path, to);
}
ssize_t readlink(const char *path, char *to, size_t n)
{
    return fails("stat", CALLER) ? fail(EIO) : REAL("readlink", ssize_t(*)(const char *, char *, size_t))(path, to, n);
}
int access(const char *path, int how)
{
    return fails("stat", CALLER) ? fail(EIO) : REAL("access", int (*)(const char *, int))(path, how);
}
int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *), void *argument)
{
    if (fails("thread", CALLER)) return EAGAIN;
    return REAL("pthread_create", int (*)(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *))(thread, attributes,
                                                                                                           start, argument);
}

// --- EGL, which is looked up by name: each look-up of one of these counts, and what it gives fails ---

static void *nothing(void) { return NULL; } // EGL_NO_DISPLAY, EGL_FALSE, EGL_NO_CONTEXT

static void *stand_in(const char *name)
{
    static const char *const makers[] = {
        "eglGetDisplay",   "eglGetPlatformDisplay", "eglGetPlatformDisplayEXT", "eglInitialize",     "eglBindAPI",
        "eglChooseConfig", "eglCreateContext",      "eglMakeCurrent",           "eglQueryDevicesEXT"};
    for (size_t i = 0; name && i < sizeof makers / sizeof *makers; i++)
        if (strcmp(name, makers[i]) == 0 && fails("egl", NULL)) return (void *)nothing;
    return NULL;
}

static void *(*egl_lookup)(const char *);
static void *lookup(const char *name)
{
    void *mine = stand_in(name);
    return mine ? mine : egl_lookup(name);
}

void *dlsym(void *handle, const char *name)
{
    void *mine = stand_in(name);
    if (mine) return mine;
    if (kind && (strcmp(kind, "egl") == 0 || strcmp(kind, "all") == 0) && strcmp(name, "eglGetProcAddress") == 0) {
        egl_lookup = (void *(*)(const char *))dlsym_real(handle, name);
        return (void *)lookup;
    }
    return dlsym_real(handle, name);
}
