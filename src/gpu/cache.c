#include "gpu/cache.h"

#include <epoxy/gl.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "base/mem.h"

enum { PATH = 1024, MOST_BYTES = 1 << 24 };

// An entry is this and `size` bytes of binary. Everything in it is checked before the driver sees the bytes, and the driver
// checks them against its own build.
typedef struct entry_head {
    char magic[8];
    uint64_t key[2], sum;
    uint32_t format, size;
} entry_head;

static const char MAGIC[8] = "SSDOPRG1";

static uint64_t fnv(uint64_t h, const void *data, size_t n)
{
    const unsigned char *p = data;
    for (size_t i = 0; i < n; i++) h = (h ^ p[i]) * 0x100000001b3u;
    return h;
}

// Two hashes of different starts over driver and source: 128 bits.
static void make_key(const gpu *g, const char *source, uint64_t key[2])
{
    static const uint64_t starts[2] = {0xcbf29ce484222325u, 0x9e3779b97f4a7c15u};
    for (int i = 0; i < 2; i++) {
        uint64_t h = fnv(starts[i], g->renderer, strlen(g->renderer) + 1);
        h = fnv(h, g->version, strlen(g->version) + 1);
        key[i] = fnv(h, source, strlen(source));
    }
}

static bool make_folder(const char *path) { return mkdir(path, 0700) == 0 || errno == EEXIST; }

// A folder that another user owns, or may write into, may hold anything.
static bool make_own_folder(const char *path)
{
    struct stat st;
    if (!make_folder(path) || stat(path, &st) != 0 || !S_ISDIR(st.st_mode)) return false;
    if (st.st_uid != geteuid() || (st.st_mode & 022)) return false;
    return (st.st_mode & 077) == 0 || chmod(path, 0700) == 0;
}

bool cache_folder(char *path, size_t size)
{
    const char *base = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    int n;
    if (base && base[0] == '/') // the specification says to ignore relative ones
        n = snprintf(path, size, "%s", base);
    else if (home && home[0] == '/')
        n = snprintf(path, size, "%s/.cache", home);
    else
        return false;
    if (n < 0 || (size_t)n + sizeof "/ssdo-filter" > size || !make_folder(path)) return false;
    strcat(path, "/ssdo-filter");
    return make_own_folder(path);
}

static bool entry_path(const uint64_t key[2], char path[PATH])
{
    char folder[PATH - 48];
    if (!cache_folder(folder, sizeof folder)) return false;
    snprintf(path, PATH, "%s/%016llx%016llx.program", folder, (unsigned long long)key[0], (unsigned long long)key[1]);
    return true;
}

// The entry's bytes, NULL if it is not there or not whole.
static unsigned char *read_entry(const char *path, const uint64_t key[2], entry_head *head)
{
    unsigned char *bytes = NULL;
    FILE *f = fopen(path, "rb");
    if (!f) return NULL;
    bool ok = fread(head, sizeof *head, 1, f) == 1 && memcmp(head->magic, MAGIC, sizeof MAGIC) == 0 && head->key[0] == key[0] &&
              head->key[1] == key[1] && head->size > 0 && head->size <= MOST_BYTES;
    if (ok) bytes = mem_zero(head->size, 1, NULL);
    ok = bytes && fread(bytes, 1, head->size, f) == head->size && fgetc(f) == EOF && fnv(0, bytes, head->size) == head->sum;
    fclose(f);
    if (ok) return bytes;
    free(bytes);
    return NULL;
}

static bool have_formats(void)
{
    GLint formats = 0;
    glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
    return formats > 0;
}

bool cache_load(const gpu *g, const char *source, GLuint program)
{
    entry_head head;
    uint64_t key[2];
    char path[PATH];
    GLint linked = 0;
    make_key(g, source, key);
    if (!have_formats() || !entry_path(key, path)) return false;
    unsigned char *bytes = read_entry(path, key, &head);
    if (!bytes) return false;
    glProgramBinary(program, head.format, bytes, (GLsizei)head.size);
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    while (glGetError() != GL_NO_ERROR) {} // a format of another driver is no error of ours
    free(bytes);
    return linked;
}

// Under a name of its own first: a reader never sees half an entry. Nothing here is worth an error; without cache all works.
static void write_entry(const char *path, const entry_head *head, const void *bytes)
{
    char temp[PATH + 8];
    snprintf(temp, sizeof temp, "%s.XXXXXX", path);
    int fd = mkstemp(temp);
    if (fd < 0) return;
    FILE *f = fdopen(fd, "wb");
    if (!f) {
        close(fd);
        unlink(temp);
        return;
    }
    bool ok = fwrite(head, sizeof *head, 1, f) == 1 && fwrite(bytes, 1, head->size, f) == head->size;
    ok = fclose(f) == 0 && ok;
    if (!ok || rename(temp, path) != 0) unlink(temp);
}

void cache_store(const gpu *g, const char *source, GLuint program)
{
    entry_head head = {{0}, {0}, 0, 0, 0};
    GLint size = 0;
    GLsizei got = 0;
    GLenum format = 0;
    char path[PATH];
    memcpy(head.magic, MAGIC, sizeof MAGIC);
    make_key(g, source, head.key);
    if (!have_formats() || !entry_path(head.key, path)) return;
    glGetProgramiv(program, GL_PROGRAM_BINARY_LENGTH, &size);
    if (size <= 0 || size > MOST_BYTES) return;
    void *bytes = mem_zero((size_t)size, 1, NULL);
    if (!bytes) return;
    glGetProgramBinary(program, size, &got, &format, bytes);
    if (glGetError() == GL_NO_ERROR && got > 0) {
        head.format = format, head.size = (uint32_t)got;
        head.sum = fnv(0, bytes, (size_t)got);
        write_entry(path, &head, bytes);
    }
    free(bytes);
}

// llvmpipe makes other code for other values of these, and Mesa's own keys do not hold them.
static uint64_t driver_settings(void)
{
    static const char *const names[] = {"LP_NATIVE_VECTOR_WIDTH", "LP_PERF", "LP_DEBUG", "GALLIVM_PERF", "GALLIVM_DEBUG"};
    uint64_t h = 0xcbf29ce484222325u;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const char *value = getenv(names[i]);
        h = fnv(h, value ? value : "", value ? strlen(value) + 1 : 0);
        h = fnv(h, "\n", 1);
    }
    return h;
}

// Mesa maps a sparse index and writes into it: on a full disk that ends the process with SIGBUS. So the index gets all its room
// before Mesa opens it; Mesa cuts it to the size it wants.
static bool make_room(const char *folder)
{
    enum { INDEX = 4 << 20, SPARE = 64 << 20 };
    char path[PATH + 64];
    struct stat st;
    struct statvfs disk;
    if (statvfs(folder, &disk) != 0 || (uint64_t)disk.f_bavail * disk.f_frsize < SPARE) return false;
    snprintf(path, sizeof path, "%s/mesa_shader_cache", folder);
    if (!make_own_folder(path)) return false;
    strcat(path, "/index");
    int fd = open(path, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0600);
    if (fd < 0) return false;
    bool ok = fstat(fd, &st) == 0 && S_ISREG(st.st_mode);
    if (ok) ok = posix_fallocate(fd, 0, st.st_size > 0 ? st.st_size : INDEX) == 0;
    return close(fd) == 0 && ok;
}

void cache_point_mesa(void)
{
    char path[PATH];
    if (getenv("MESA_SHADER_CACHE_DIR") || getenv("MESA_SHADER_CACHE_DISABLE")) return;
    bool ok = cache_folder(path, sizeof path - 24);
    if (ok) sprintf(path + strlen(path), "/mesa-%016llx", (unsigned long long)driver_settings());
    if (ok && make_own_folder(path) && make_room(path))
        setenv("MESA_SHADER_CACHE_DIR", path, 0);
    else
        setenv("MESA_SHADER_CACHE_DISABLE", "true", 0);
}
