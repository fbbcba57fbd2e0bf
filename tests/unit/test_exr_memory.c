// Every allocation fails once: an error, no crash, no file left behind. SSDO_FAIL_ALLOC counts over the life of a process, so
// each try is a process of its own: this program with the argument "try".
#include <sys/wait.h>

#include <openexr.h>

#include "exrio_support.h"

enum { SUCCEEDED = 0, FAILED_WELL = 10, FAILED_BADLY = 11 };

// Writes and reads one file without cmocka.
static int try_once(const char *path)
{
    static const uint16_t half[40 * 20];
    static const float depth[40 * 20];
    exrio_out_channel channels[] = {{"b.R", SAMPLE_HALF, half}, {"Z", SAMPLE_FLOAT, depth}};
    exrio_out_attr ours[] = {{.name = "ssdo/version", .kind = EXRIO_OUT_STRING, .string = "1"}};
    exrio_out_part part = {.data_window = {0, 0, 39, 19},
                           .display_window = {0, 0, 39, 19},
                           .pixel_aspect = 1,
                           .compression = EXR_COMPRESSION_ZIP,
                           .channels = channels,
                           .channel_count = 2,
                           .attributes = ours,
                           .attribute_count = 1};
    error e = {0};
    exrio_file *f = NULL;
    bool ok = exrio_write(path, &part, 1, 2, &e);
    if (!ok && access(path, F_OK) == 0) return FAILED_BADLY;
    if (ok) ok = exrio_file_open(path, &f, &e);
    if (ok) {
        f->parts[0].channels[1].wanted = true;
        ok = exrio_file_load(f, 2, &e);
        if (!ok && f->parts[0].channels[1].data) return FAILED_BADLY;
        exrio_file_close(f);
    }
    if (ok) return SUCCEEDED;
    return e.message[0] && (e.code == ERR_MEMORY || e.code == ERR_INPUT || e.code == ERR_OUTPUT) ? FAILED_WELL : FAILED_BADLY;
}

static void test_every_allocation(void **state)
{
    (void)state;
    char exe[4096] = "";
    assert_true(readlink("/proc/self/exe", exe, sizeof exe - 1) > 0);
    int n = 1, status = FAILED_WELL;
    for (; n < 2000 && status == FAILED_WELL; n++) {
        int raw = run_command("SSDO_FAIL_ALLOC=%d '%s' try '%s'", n, exe, in_scratch("a.exr"));
        assert_true(WIFEXITED(raw));
        status = WEXITSTATUS(raw);
        run_command("rm -f '%s'", in_scratch("a.exr"));
        assert_int_equal(run_command("test -z \"$(ls -A '%s')\"", scratch_folder), 0);
    }
    assert_int_equal(status, SUCCEEDED); // beyond the last allocation
    assert_true(n > 30);                 // and there were many before it
}

int main(int argc, char **argv)
{
    if (argc == 3 && strcmp(argv[1], "try") == 0) return try_once(argv[2]);
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_every_allocation)};
    return cmocka_run_group_tests(tests, make_scratch, remove_scratch);
}
