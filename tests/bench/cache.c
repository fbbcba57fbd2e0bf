#include "bench.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// FNV-1a, 64 bits.
cache_key cache_add(cache_key k, const void *data, size_t size)
{
    const unsigned char *p = data;
    for (size_t i = 0; i < size; i++) k = (k ^ p[i]) * 0x100000001b3ull;
    return k;
}

cache_key cache_start(const char *kind) { return cache_add(0xcbf29ce484222325ull, kind, strlen(kind)); }

cache_key cache_add_file(cache_key k, const char *path)
{
    char buf[65536];
    FILE *f = fopen(path, "rb");
    if (!f) return k;
    for (size_t n; (n = fread(buf, 1, sizeof buf, f)) > 0;) k = cache_add(k, buf, n);
    fclose(f);
    return k;
}

static void name_of(char *path, size_t size, const char *dir, cache_key k) { snprintf(path, size, "%s/%016llx", dir, k); }

bool bench_cache_load(const char *dir, cache_key k, void *data, size_t size)
{
    char path[512], more;
    name_of(path, sizeof path, dir, k);
    FILE *f = fopen(path, "rb");
    if (!f) return false;
    bool ok = fread(data, 1, size, f) == size && fread(&more, 1, 1, f) == 0;
    fclose(f);
    return ok;
}

// A cache that cannot be written costs time, nothing else.
void bench_cache_store(const char *dir, cache_key k, const void *data, size_t size)
{
    char path[512], temp[560];
    name_of(path, sizeof path, dir, k);
    snprintf(temp, sizeof temp, "%s.%d", path, (int)getpid());
    FILE *f = fopen(temp, "wb");
    if (!f) return;
    bool ok = fwrite(data, 1, size, f) == size;
    ok = fclose(f) == 0 && ok;
    if (!ok || rename(temp, path) != 0) remove(temp);
}
