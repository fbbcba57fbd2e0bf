// Progress: what each form prints, in which order, and that the bar knows how long it will take.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/progress.h"

// Runs two frames, of which the second is skipped after reading, and returns what came out on standard output.
static char *output_of(progress_form form, log_level level)
{
    log_t log;
    progress p;
    FILE *f = tmpfile();
    char *text = calloc(1, 4096);
    assert_true(f && text);
    fflush(stdout);
    int before = dup(STDOUT_FILENO);
    assert_true(before >= 0 && dup2(fileno(f), STDOUT_FILENO) >= 0);
    log_init(&log, level);
    progress_begin(&p, form, 2, &log);
    for (int i = 0; i < PROGRESS_STEPS; i++) progress_step(&p);
    progress_finish(&p, 0);
    progress_line(&p, "frame %d", 1);
    progress_step(&p);
    progress_finish(&p, PROGRESS_STEPS - 1);
    progress_line(&p, "frame %d", 2);
    progress_end(&p);
    progress_fail(form, "1 of 2 frames failed: 2");
    log_free(&log);
    fflush(stdout);
    assert_true(dup2(before, STDOUT_FILENO) >= 0);
    close(before);
    rewind(f);
    assert_true(fread(text, 1, 4095, f) > 0 || form == PROGRESS_NONE || form == PROGRESS_AUTO);
    fclose(f);
    return text;
}

static void expect(progress_form form, log_level level, const char *wanted)
{
    char *text = output_of(form, level);
    assert_string_equal(text, wanted);
    free(text);
}

static void each_form_prints_its_lines(void **state)
{
    (void)state;
    expect(PROGRESS_PLAIN, LOG_WARN, "0 %\n16 %\n33 %\n50 %\nframe 1\n66 %\n100 %\nframe 2\n");
    expect(PROGRESS_ALF, LOG_WARN,
           "ALF_PROGRESS 0%\nALF_PROGRESS 16%\nALF_PROGRESS 33%\nALF_PROGRESS 50%\nframe 1\nALF_PROGRESS 66%\nALF_PROGRESS 100%\n"
           "frame 2\n");
    expect(PROGRESS_OPENJD, LOG_QUIET,
           "openjd_progress: 0\nopenjd_progress: 16\nopenjd_progress: 33\nopenjd_progress: 50\nopenjd_status: frame 1\n"
           "openjd_progress: 66\nopenjd_progress: 100\nopenjd_status: frame 2\nopenjd_fail: 1 of 2 frames failed: 2\n");
    expect(PROGRESS_NONE, LOG_WARN, "frame 1\nframe 2\n");
    expect(PROGRESS_NONE, LOG_QUIET, "");
    expect(PROGRESS_AUTO, LOG_QUIET, "");
}

// A thousand frames do not make three thousand lines.
static void percents_are_printed_once(void **state)
{
    (void)state;
    log_t log;
    progress p;
    log_init(&log, LOG_WARN);
    p = (progress){.form = PROGRESS_OPENJD, .log = &log, .frames = 1000, .shown = -1};
    FILE *f = tmpfile();
    assert_non_null(f);
    fflush(stdout);
    int before = dup(STDOUT_FILENO), lines = 0;
    assert_true(dup2(fileno(f), STDOUT_FILENO) >= 0);
    for (int i = 0; i < 1000 * PROGRESS_STEPS; i++) progress_step(&p);
    fflush(stdout);
    assert_true(dup2(before, STDOUT_FILENO) >= 0);
    close(before);
    rewind(f);
    for (int c; (c = fgetc(f)) != EOF;) lines += c == '\n';
    fclose(f);
    log_free(&log);
    assert_int_equal(lines, 101);
}

static void the_bar_tells_the_time_left(void **state)
{
    (void)state;
    char text[160];
    progress p = {.form = PROGRESS_BAR, .frames = 12};
    progress_bar_text(&p, 1.0, text, sizeof text);
    assert_string_equal(text, "[..............................]   0 %  0 of 12 frames"); // nothing is known yet
    // Five frames were there already, one took 6 s: six more of them.
    p.done = 6 * PROGRESS_STEPS, p.finished = 6, p.skipped = 5 * PROGRESS_STEPS;
    progress_bar_text(&p, 6.0, text, sizeof text);
    assert_string_equal(text, "[###############...............]  50 %  6 of 12 frames  0:36 left");
    p.skipped = 0;
    progress_bar_text(&p, 7384.0, text, sizeof text);
    assert_string_equal(text, "[###############...............]  50 %  6 of 12 frames  2:03:04 left");
    p.done = 12 * PROGRESS_STEPS, p.finished = 12;
    progress_bar_text(&p, 9.0, text, sizeof text);
    assert_string_equal(text, "[##############################] 100 %  12 of 12 frames  0:00 left");
    p = (progress){.form = PROGRESS_BAR, .frames = 1, .done = 1};
    progress_bar_text(&p, 2.0, text, sizeof text);
    assert_string_equal(text, "[##########....................]  33 %  0 of 1 frame  0:04 left");
    assert_true(progress_eta(10.0, 0, 5) < 0.0);
    assert_true(progress_eta(10.0, 4, 2) == 5.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_form_prints_its_lines),
        cmocka_unit_test(percents_are_printed_once),
        cmocka_unit_test(the_bar_tells_the_time_left),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
