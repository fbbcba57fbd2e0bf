// libFuzzer target: frame ranges and file patterns. The input is a range up to the first newline, then a pattern.

#include "base/sort.h"
#include "cli/frames.h"
#include "fuzz.h"

static void check_range(const char *text)
{
    frame_list list = {0};
    error e = {0};
    if (!frames_parse(text, &list, &e)) {
        CHECK(e.code != ERR_NONE && e.message[0]);
        return;
    }
    CHECK(list.count > 0 && list.count <= FRAMES_MAX);
    sort_ints(list.frames, (size_t)list.count);
    for (int i = 1; i < list.count; i++) CHECK(list.frames[i] != list.frames[i - 1]); // every frame once
    frames_free(&list);
}

static void check_pattern(const char *pattern, int frame)
{
    char path[300], other[300];
    bool fits = pattern_path(pattern, frame, path, sizeof path);
    if (fits) CHECK(memchr(path, 0, sizeof path));
    if (fits && pattern_is(pattern) && pattern_path(pattern, frame ^ 1, other, sizeof other)) CHECK(strcmp(path, other) != 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    if (!text) return 0;
    memcpy(text, data, size);
    text[size] = '\0';
    char *pattern = strchr(text, '\n');
    if (pattern) *pattern++ = '\0';
    check_range(text);
    static const int frames[] = {0, 1, -1, 7, 1001, 99999, INT32_MAX, INT32_MIN};
    for (size_t i = 0; pattern && i < sizeof frames / sizeof *frames; i++) check_pattern(pattern, frames[i]);
    free(text);
    return 0;
}
