// Mesa's cache of machine code: see cache.h.
//
//   ssdo-filter/mesa-SETTINGS/KEY-DIGEST               an entry; the digest is over key and content
//   ssdo-filter/mesa-SETTINGS/run-PID-PLACE/           a process's own folder, as MESA_SHADER_CACHE_DIR
//                             mesa_shader_cache/KE/Y   the same entry as Mesa looks for it
//                             mesa_shader_cache/index  Mesa's own, a sparse file that it maps
//   ssdo-filter/mesa-SETTINGS/spare/                   the folders of a run that has ended, empty, for the next one
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <time.h>
#include <unistd.h>

#include "base/digest.h"
#include "base/process.h"
#include "gpu/cache.h"
#include "gpu/cache_file.h"

enum { KEY = 40, ENTRY_NAME = KEY + 1 + DIGEST_TEXT, MOST_ENTRIES = 1024, OLD_DAYS = 7 };

static const char HEX[] = "0123456789abcdef", MESA[] = "mesa_shader_cache", LEFT[] = "spare",
                  FOLDER_VARIABLE[] = "MESA_SHADER_CACHE_DIR";

static bool join(char path[CACHE_PATH], const char *folder, const char *name)
{
    int n = snprintf(path, CACHE_PATH, "%s/%s", folder, name);
    return n > 0 && n < CACHE_PATH;
}

// --- names ---

// llvmpipe makes other code for other values of these, and Mesa's own keys do not hold them.
static bool driver_settings(char text[DIGEST_TEXT + 1])
{
    static const char *const names[] = {"LP_NATIVE_VECTOR_WIDTH", "LP_PERF", "LP_DEBUG", "GALLIVM_PERF", "GALLIVM_DEBUG"};
    digester *d = digest_begin(NULL);
    if (!d) return false;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) digest_put_text(d, getenv(names[i]));
    digest_format(digest_of(d), text);
    digest_free(d);
    return true;
}

static bool store_folder(char path[CACHE_PATH])
{
    char folder[CACHE_PATH], name[8 + DIGEST_TEXT] = "mesa-";
    return cache_folder(folder, sizeof folder) && driver_settings(name + 5) && join(path, folder, name);
}

static void run_name(char name[64]) { snprintf(name, 64, "run-%ld-%016" PRIx64, (long)getpid(), process_place()); }

// Whether a folder is the one that this process has made, wherever that was.
static bool is_own_run(const char *path)
{
    char name[64];
    const char *slash = strrchr(path, '/');
    run_name(name);
    return slash && strcmp(slash + 1, name) == 0;
}

static bool is_entry(const char *name)
{
    return strlen(name) == ENTRY_NAME && strspn(name, HEX) == KEY && name[KEY] == '-' &&
           strspn(name + KEY + 1, HEX) == DIGEST_TEXT;
}

// KEY-DIGEST of a content.
static void entry_name(const char key[KEY], const void *bytes, size_t size, char name[ENTRY_NAME + 1])
{
    struct {
        char key[KEY];
        digest content;
    } bound;
    memcpy(bound.key, key, KEY);
    bound.content = digest_bytes(bytes, size);
    memcpy(name, key, KEY);
    name[KEY] = '-';
    digest_format(digest_bytes(&bound, sizeof bound), name + KEY + 1);
}

// --- folders of processes ---

static int remove_one(const char *path, const struct stat *st, int type, struct FTW *where)
{
    (void)st, (void)type, (void)where;
    remove(path);
    return 0;
}

static void remove_run(const char *path) { nftw(path, remove_one, 8, FTW_DEPTH | FTW_PHYS | FTW_MOUNT); }

// A process that is killed leaves its folder. Those of other machines tell by their age only; a process that still runs there
// compiles what it misses.
static void remove_if_abandoned(void *context, const char *folder, const char *name)
{
    char path[CACHE_PATH], *end;
    struct stat st;
    (void)context;
    if (strncmp(name, "run-", 4) != 0 || !join(path, folder, name)) return;
    long pid = strtol(name + 4, &end, 10);
    uint64_t place = *end == '-' ? strtoull(end + 1, NULL, 16) : 0;
    bool old = lstat(path, &st) == 0 && time(NULL) - st.st_mtim.tv_sec > OLD_DAYS * 24 * 3600;
    if (old || process_is_gone(pid, place)) remove_run(path);
}

// --- the spare folders ---
//
// ext4 does not reuse an inode in the seconds after it was freed, and looks for a free one beyond all of those. If every run made
// and removed two hundred folders, they would cost it more than a small frame does.

static void remove_within(void *context, const char *folder, const char *name)
{
    char path[CACHE_PATH];
    (void)context;
    if (join(path, folder, name)) remove_run(path);
}

static bool is_folder(const char *path)
{
    struct stat st;
    return lstat(path, &st) == 0 && S_ISDIR(st.st_mode);
}

static void strip_one(void *context, const char *folder, const char *name)
{
    char path[CACHE_PATH];
    (void)context;
    if (!join(path, folder, name)) return;
    if (strlen(name) == 2 && strspn(name, HEX) == 2 && is_folder(path))
        cache_each(path, remove_within, NULL);
    else
        remove_run(path);
}

// The run's folder: one that was spare, or a new one. Nothing is in it, whatever the spare one held.
static bool take_folder(const char *store, const char *run, const char *mesa)
{
    char spare[CACHE_PATH];
    bool taken = join(spare, store, LEFT) && rename(spare, run) == 0;
    if (taken && is_folder(run) && cache_own_folder(run) && is_folder(mesa) && cache_own_folder(mesa)) {
        cache_each(mesa, strip_one, NULL);
        return true;
    }
    if (taken) remove_run(run);
    return mkdir(run, 0700) == 0 && mkdir(mesa, 0700) == 0;
}

// Of processes that end at the same time, one leaves its folder.
static void leave_folder(const char *store, const char *run, const char *mesa)
{
    char spare[CACHE_PATH];
    cache_each(mesa, strip_one, NULL);
    if (!join(spare, store, LEFT) || rename(run, spare) != 0) remove_run(run);
}

// --- before EGL starts ---

// Mesa maps a sparse index and writes into it: on a full disk that ends the process with SIGBUS. So the index gets all its room
// before Mesa opens it; Mesa cuts it to the size it wants.
static bool make_index(const char *mesa)
{
    enum { INDEX = 4 << 20 };
    char path[CACHE_PATH];
    if (!join(path, mesa, "index")) return false;
    int fd = open(path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (fd < 0) return false;
    bool ok = posix_fallocate(fd, 0, INDEX) == 0;
    return close(fd) == 0 && ok;
}

// Shows an entry to Mesa if it holds; else it goes. `context`: the process's folder.
static void show_entry(void *context, const char *folder, const char *name)
{
    const char *mesa = context;
    char path[CACHE_PATH], to[CACHE_PATH], wanted[ENTRY_NAME + 1];
    size_t size = 0;
    if (!is_entry(name) || !join(path, folder, name)) return;
    void *bytes = cache_read(path, &size);
    if (bytes) entry_name(name, bytes, size, wanted);
    int n = snprintf(to, sizeof to, "%s/%.2s", mesa, name);
    if (!bytes || strcmp(wanted, name) != 0) {
        unlink(path);
    } else if (n > 0 && n + KEY < CACHE_PATH && (mkdir(to, 0700) == 0 || errno == EEXIST)) {
        snprintf(to + n, sizeof to - (size_t)n, "/%.*s", KEY - 2, name + 2);
        if (link(path, to) != 0) {
            if (errno == EEXIST)
                unlink(path); // two processes have made an entry each
            else
                cache_write(to, bytes, size); // not every file system has links
        }
    }
    free(bytes);
}

static bool open_run(const char *store, char run[CACHE_PATH])
{
    enum { SPARE = 64 << 20 };
    char name[64], mesa[CACHE_PATH];
    struct statvfs disk;
    if (!cache_own_folder(store)) return false;
    cache_each(store, remove_if_abandoned, NULL);
    if (statvfs(store, &disk) != 0 || (uint64_t)disk.f_bavail * disk.f_frsize < SPARE) return false;
    run_name(name);
    if (!join(run, store, name) || !join(mesa, run, MESA)) return false;
    remove_run(run); // of a process that had the same number
    if (take_folder(store, run, mesa) && make_index(mesa)) {
        cache_each(store, show_entry, mesa);
        return true;
    }
    remove_run(run);
    return false;
}

void cache_open_mesa(void)
{
    char store[CACHE_PATH], run[CACHE_PATH];
    const char *set = getenv(FOLDER_VARIABLE);
    if (getenv("MESA_SHADER_CACHE_DISABLE") || (set && (!is_own_run(set) || is_folder(set)))) return; // or open already
    if (!store_folder(store) || !open_run(store, run)) {
        setenv("MESA_SHADER_CACHE_DISABLE", "true", 0);
        return;
    }
    if (!set || strcmp(set, run) != 0) setenv(FOLDER_VARIABLE, run, 1);
    setenv("MESA_DISK_CACHE_MULTI_FILE", "true", 0); // a file for each entry, in every version of Mesa
}

// --- after EGL has ended ---

// A name in mesa_shader_cache/KE: what has one link is new.
static void keep_entry(void *context, const char *folder, const char *name)
{
    const char *store = context, *first = strrchr(folder, '/') + 1;
    char path[CACHE_PATH], key[KEY + 1], kept[ENTRY_NAME + 1], to[CACHE_PATH];
    struct stat st;
    size_t size = 0;
    if (strlen(name) != KEY - 2 || strspn(name, HEX) != KEY - 2 || !join(path, folder, name)) return;
    if (lstat(path, &st) != 0 || st.st_nlink != 1) return;
    snprintf(key, sizeof key, "%.2s%.38s", first, name);
    void *bytes = cache_read(path, &size);
    if (!bytes) return;
    entry_name(key, bytes, size, kept);
    if (join(to, store, kept) && link(path, to) != 0 && errno != EEXIST) cache_write(to, bytes, size);
    free(bytes);
}

static void keep_folder(void *context, const char *folder, const char *name)
{
    char path[CACHE_PATH];
    if (strlen(name) == 2 && strspn(name, HEX) == 2 && join(path, folder, name)) cache_each(path, keep_entry, context);
}

void cache_close_mesa(void)
{
    char store[CACHE_PATH], mesa[CACHE_PATH];
    const char *run = getenv(FOLDER_VARIABLE);
    if (!run || !is_own_run(run) || !join(mesa, run, MESA)) return;
    int n = snprintf(store, sizeof store, "%.*s", (int)(strrchr(run, '/') - run), run);
    if (n <= 0 || n >= CACHE_PATH) return;
    cache_each(mesa, keep_folder, store);
    leave_folder(store, run, mesa);
    cache_trim(store, is_entry, MOST_ENTRIES);
}
