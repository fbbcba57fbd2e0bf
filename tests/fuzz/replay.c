// The fuzz targets without libFuzzer: a target's corpus, in which what was once found stays, is fed to it once.
#include <dirent.h>

#include "fuzz.h"

static void feed(const char *path)
{
    enum { MOST = 1 << 20 };
    uint8_t *bytes = malloc(MOST);
    FILE *f = fopen(path, "rb");
    CHECK(bytes && f);
    size_t n = fread(bytes, 1, MOST, f);
    fclose(f);
    uint8_t *copy = malloc(n); // no byte more: a sanitizer sees what reads on
    CHECK(copy || n == 0);
    if (n) memcpy(copy, bytes, n);
    free(bytes);
    LLVMFuzzerTestOneInput(copy, n);
    free(copy);
}

int main(int argc, char **argv)
{
    const char *name = strstr(argv[0], "fuzz_");
    char folder[256], path[600];
    int count = 0;
    (void)argc;
    CHECK(name);
    snprintf(folder, sizeof folder, "tests/fuzz/corpus/%s", name + 5);
    DIR *d = opendir(folder);
    CHECK(d);
    for (struct dirent *f; (f = readdir(d));) {
        if (f->d_name[0] == '.') continue;
        snprintf(path, sizeof path, "%s/%s", folder, f->d_name);
        feed(path);
        count++;
    }
    closedir(d);
    CHECK(count > 0);
    printf("figure: %s: %d inputs\n", name, count);
    return 0;
}
