// The choice of the device, on tables of machines that are not here.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "gpu/choose.h"

// clang-format off
#define GPU(number) {.nvidia = true, .cuda = (number)}
#define OTHER {.cuda = -1}
#define SOFTWARE {.software = true, .cuda = -1}
// clang-format on

// The order as text, "210".
static void expect(const gpu_candidate *list, int count, const char *visible, const char *wanted)
{
    int order[16];
    char text[17] = "";
    int n = gpu_choose(list, count, visible, order);
    for (int i = 0; i < n; i++) text[i] = (char)('0' + order[i]);
    text[n] = '\0';
    if (strcmp(text, wanted) != 0)
        fail_msg("CUDA_VISIBLE_DEVICES=%s: %s instead of %s", visible ? visible : "(unset)", text, wanted);
}

static void hardware_comes_before_software(void **state)
{
    (void)state;
    const gpu_candidate farm[] = {SOFTWARE}, desk[] = {SOFTWARE, OTHER, GPU(0), OTHER};
    expect(farm, 1, NULL, "0");
    expect(farm, 1, "0", "0"); // a variable left over does not keep the CPU away
    expect(desk, 4, NULL, "1230");
    expect(NULL, 0, "0", "");
}

// Two cards in EGL's own order, each with Mesa's twin, which has no CUDA number and will not start.
static void the_assigned_card_is_taken(void **state)
{
    (void)state;
    const gpu_candidate node[] = {GPU(1), GPU(0), OTHER, OTHER, SOFTWARE};
    expect(node, 5, NULL, "01234");
    expect(node, 5, "0", "1234");
    expect(node, 5, "1", "0234");
    expect(node, 5, "0,1", "10234");
    expect(node, 5, "1,0", "01234");
    expect(node, 5, "3", "234"); // a card that is not there
}

static void hidden_cards_are_left_alone(void **state)
{
    (void)state;
    const gpu_candidate node[] = {GPU(0), GPU(1), OTHER, SOFTWARE};
    expect(node, 4, "", "23");
    expect(node, 4, "-1", "23");
    expect(node, 4, "NoDevFiles", "23"); // what Slurm sets for a job without a GPU
    expect(node, 4, "1,-1,0", "123");    // CUDA stops reading at the first item that is none
    expect(node, 4, "1x", "23");
}

// The driver has applied the variable: the card it shows is number 0, whatever the variable calls it.
static void numbers_after_the_variable_was_applied(void **state)
{
    (void)state;
    const gpu_candidate node[] = {GPU(-1), GPU(0), GPU(-1), SOFTWARE}, two[] = {GPU(1), GPU(-1), GPU(0)};
    expect(node, 4, "1", "13");
    expect(node, 4, "2", "13");
    expect(two, 3, "2,0", "20");
    expect(node, 4, NULL, "0123"); // not set: nothing was applied to us
}

static void cards_are_found_by_uuid(void **state)
{
    (void)state;
    const gpu_candidate a = {.nvidia = true, .cuda = 0, .has_uuid = true, .uuid = {0x8f, 0x6a, 0x01, 0x23, 0x45}},
                        b = {.nvidia = true, .cuda = 1, .has_uuid = true, .uuid = {0x8f, 0x6b, 0x01, 0x23, 0x45}},
                        node[] = {a, b, SOFTWARE}, mute[] = {GPU(0), GPU(1), SOFTWARE};
    expect(node, 3, "GPU-8f6b0123-45", "12");
    expect(node, 3, "GPU-8F6A", "02");
    expect(node, 3, "GPU-8f6b,GPU-8f6a", "102");
    expect(node, 3, "GPU-77", "2");
    expect(node, 3, "GPU-", "2");
    expect(node, 3, "GPU-8f6b0123450000000000000000000000", "12");
    expect(node, 3, "GPU-8f6b01234500000000000000000000000", "2"); // longer than a UUID is
    expect(mute, 3, "GPU-8f6b", "012");                            // EGL tells none: any may be meant
    expect(node, 3, "MIG-8f6b", "012");
}

static void a_missing_driver_is_named(void **state)
{
    (void)state;
    gpu_surroundings s = {.node = false};
    assert_null(gpu_missing_vendor(&s));
    s.node = true;
    assert_non_null(strstr(gpu_missing_vendor(&s), "libEGL_nvidia.so.0 cannot be loaded"));
    s.vendor = true;
    assert_non_null(strstr(gpu_missing_vendor(&s), "libEGL_nvidia.so.0 cannot be loaded"));
    s = (gpu_surroundings){.node = true, .library = true};
    assert_non_null(strstr(gpu_missing_vendor(&s), "/usr/share/glvnd/egl_vendor.d"));
    s.vendor = true;
    assert_non_null(strstr(gpu_missing_vendor(&s), "different versions"));
    s.listed = true;
    assert_null(gpu_missing_vendor(&s));
}

static void touch(const char *root, const char *path)
{
    char full[512];
    for (const char *slash = strchr(path + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        snprintf(full, sizeof full, "%s%.*s", root, (int)(slash - path), path);
        mkdir(full, 0700);
    }
    snprintf(full, sizeof full, "%s%s", root, path);
    FILE *f = fopen(full, "w");
    assert_non_null(f);
    fclose(f);
}

static void the_machine_is_looked_at(void **state)
{
    (void)state;
    char root[] = "/tmp/ssdo-root-XXXXXX", command[64];
    assert_non_null(mkdtemp(root));
    gpu_surroundings s = gpu_look_around(root);
    assert_false(s.node || s.vendor || s.listed || s.library);
    touch(root, "/usr/share/glvnd/egl_vendor.d/50_mesa.json");
    touch(root, "/dev/nvidia0");
    s = gpu_look_around(root);
    assert_true(s.node && !s.vendor);
    touch(root, "/usr/share/glvnd/egl_vendor.d/10_nvidia.json");
    s = gpu_look_around(root);
    assert_true(s.node && s.vendor);
    snprintf(command, sizeof command, "rm -rf %s", root);
    assert_int_equal(system(command), 0);
}

static void expect_why(const gpu_surroundings *s, const char *part)
{
    if (!strstr(gpu_why_software(s), part)) fail_msg("'%s' does not say '%s'", gpu_why_software(s), part);
}

static void a_software_device_has_its_reason(void **state)
{
    (void)state;
    expect_why(&(gpu_surroundings){.node = false}, "there is no GPU");
    expect_why(&(gpu_surroundings){.module = true}, "--gpus all");
    expect_why(&(gpu_surroundings){.node = true, .module = true, .node_denied = true, .render = true},
               "may not open /dev/nvidia0");
    expect_why(&(gpu_surroundings){.node = true, .module = true}, "libEGL_nvidia.so.0 cannot be loaded");
    expect_why(&(gpu_surroundings){.node = true, .library = true}, "egl_vendor.d");
    expect_why(&(gpu_surroundings){.node = true, .library = true, .vendor = true, .listed = true, .hidden = true},
               "CUDA_VISIBLE_DEVICES");
    expect_why(&(gpu_surroundings){.node = true, .library = true, .vendor = true, .listed = true}, "gives no OpenGL 4.5");
    expect_why(&(gpu_surroundings){.render = true, .render_denied = true, .card = true}, "may not open /dev/dri/renderD*");
    expect_why(&(gpu_surroundings){.render = true, .card = true}, "libgl1-mesa-dri");
    expect_why(&(gpu_surroundings){.card = true}, "--device /dev/dri");
}

// Root may open everything, so another user looks.
static gpu_surroundings look_as_nobody(const char *root)
{
    gpu_surroundings s = {0};
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    pid_t child = fork();
    if (child == 0) {
        bool nobody = geteuid() != 0 || (setgid(65534) == 0 && setuid(65534) == 0);
        s = gpu_look_around(root);
        _exit(nobody && write(ends[1], &s, sizeof s) == (ssize_t)sizeof s ? 0 : 1);
    }
    close(ends[1]);
    assert_int_equal(read(ends[0], &s, sizeof s), sizeof s);
    close(ends[0]);
    assert_int_equal(waitpid(child, NULL, 0), child);
    return s;
}

static void forbid(const char *root, const char *path)
{
    char full[512];
    snprintf(full, sizeof full, "%s%s", root, path);
    assert_int_equal(chmod(full, 0), 0);
}

static void what_may_not_be_opened_is_seen(void **state)
{
    (void)state;
    char root[] = "/tmp/ssdo-root-XXXXXX", command[64];
    assert_non_null(mkdtemp(root));
    mode_t mask = umask(0);
    touch(root, "/sys/class/drm/renderD128");
    gpu_surroundings s = gpu_look_around(root);
    assert_true(s.card && !s.render && !s.node && !s.module);
    touch(root, "/dev/dri/renderD128");
    touch(root, "/dev/nvidiactl");
    touch(root, "/sys/module/nvidia/version");
    snprintf(command, sizeof command, "chmod -R a+rwX %s", root);
    assert_int_equal(system(command), 0);
    s = look_as_nobody(root);
    assert_true(s.render && !s.render_denied && s.node && !s.node_denied && s.module);
    forbid(root, "/dev/dri/renderD128");
    s = look_as_nobody(root);
    assert_true(s.render && s.render_denied && !s.node_denied);
    touch(root, "/dev/dri/renderD129"); // another card's
    s = look_as_nobody(root);
    assert_false(s.render_denied);
    forbid(root, "/dev/nvidiactl");
    s = look_as_nobody(root);
    assert_true(s.node_denied);
    umask(mask);
    snprintf(command, sizeof command, "rm -rf %s", root);
    assert_int_equal(system(command), 0);
}

static void a_device_has_a_short_name(void **state)
{
    (void)state;
    char name[64];
    gpu_device_name("llvmpipe (LLVM 15.0.6, 256 bits)", name, sizeof name);
    assert_string_equal(name, "llvmpipe");
    gpu_device_name("NVIDIA RTX A6000/PCIe/SSE2", name, sizeof name);
    assert_string_equal(name, "NVIDIA RTX A6000/PCIe/SSE2");
    gpu_device_name("AMD Radeon RX 6800 (navi21, LLVM 15.0.6, DRM 3.49, 6.1.0-18-amd64)", name, sizeof name);
    assert_string_equal(name, "AMD Radeon RX 6800");
    gpu_device_name("", name, sizeof name);
    assert_string_equal(name, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hardware_comes_before_software),   cmocka_unit_test(the_assigned_card_is_taken),
        cmocka_unit_test(hidden_cards_are_left_alone),      cmocka_unit_test(numbers_after_the_variable_was_applied),
        cmocka_unit_test(cards_are_found_by_uuid),          cmocka_unit_test(a_missing_driver_is_named),
        cmocka_unit_test(the_machine_is_looked_at),         cmocka_unit_test(a_device_has_a_short_name),
        cmocka_unit_test(a_software_device_has_its_reason), cmocka_unit_test(what_may_not_be_opened_is_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
