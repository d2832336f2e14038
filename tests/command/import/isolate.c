/* Work in a separate process: answers arrive complete, and every failure gives an error of one line. */
#include "command/import/isolate.h"

#include "command/assets/mesh.h"
#include "command/assets/transfer.h"

#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include <unity.h>

static const struct isolate_limits limits = {
    .memory = 64 << 20, .seconds = 1, .milliseconds = 60000, .answer = 1 << 20};
static struct answer answer;
static struct error error;

void setUp(void)
{
    error_clear(&error);
    answer = (struct answer){0};
}

void tearDown(void)
{
    free(answer.data);
}

static void expect_failure(isolated_work *work, void *user, const char *reason)
{
    TEST_ASSERT_EQUAL_INT(-1, isolate_run("name", &limits, work, user, &answer, &error));
    TEST_ASSERT_EQUAL_STRING(reason, error.text);
    TEST_ASSERT_NULL(answer.data);
    /* no process remains */
    TEST_ASSERT_EQUAL_INT(-1, waitpid(-1, NULL, WNOHANG));
}

static int say_much(void *user, struct answer *out, struct error *reason)
{
    (void)reason;
    for (uint32_t i = 0; i < *(const uint32_t *)user; i++)
        if (isolate_append(out, &i, sizeof i))
            return -1;
    return 0;
}

static void answers_come_back_whole(void)
{
    uint32_t count = 200000; /* more than a pipe's buffer */
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, isolate_run("name", &limits, say_much, &count, &answer, &error),
                                  error.text);
    TEST_ASSERT_EQUAL_UINT64(count * sizeof count, answer.bytes);
    for (uint32_t i = 0; i < count; i++)
        TEST_ASSERT_EQUAL_UINT32(i, ((const uint32_t *)(const void *)answer.data)[i]);
}

static void answers_that_are_too_long_are_refused(void)
{
    uint32_t count = 300000;
    expect_failure(say_much, &count, "name: more than 1048576 bytes when read");
}

static int give_reason(void *user, struct answer *out, struct error *reason)
{
    (void)out;
    return error_set(reason, "%s", (const char *)user);
}

static void reasons_come_back_as_one_line(void)
{
    char text[] = "name: two\nlines\tand\x1b more";
    expect_failure(give_reason, text, "name: two lines and  more");
}

static int crash(void *user, struct answer *out, struct error *reason)
{
    (void)out;
    (void)reason;
    fprintf(stderr, "not to be seen\n");
    raise(*(const int *)user);
    _exit(3);
}

static void crashes_are_one_line(void)
{
    int segmentation = SIGSEGV, abortion = SIGABRT, none = 0;
    expect_failure(crash, &segmentation,
                   "name: reading it ended with Segmentation fault, expected a file that is not damaged");
    error_clear(&error);
    expect_failure(crash, &abortion,
                   "name: reading it ended with Aborted, expected a file that is not damaged");
    error_clear(&error);
    expect_failure(crash, &none, "name: reading it ended early, expected a file that is not damaged");
}

static int run_forever(void *user, struct answer *out, struct error *reason)
{
    const volatile int *sleep = user;
    (void)out;
    (void)reason;
    while (*sleep >= 0)
        if (*sleep)
            pause();
    return 0;
}

static void endless_work_is_ended(void)
{
    int sleep = 0;
    expect_failure(run_forever, &sleep, "name: reading it takes more than 1 seconds of processor time");
}

static void endless_sleep_is_ended(void)
{
    static const struct isolate_limits short_limits = {
        .memory = 64 << 20, .seconds = 1, .milliseconds = 100, .answer = 1};
    int sleep = 1;
    TEST_ASSERT_EQUAL_INT(-1, isolate_run("name", &short_limits, run_forever, &sleep, &answer, &error));
    TEST_ASSERT_EQUAL_STRING("name: reading it takes more than 0.1 seconds", error.text);
}

/* Allocates memory until it is refused. */
static int take_memory(void *user, struct answer *out, struct error *reason)
{
    (void)user;
    (void)out;
    for (size_t taken = 0; taken < (size_t)1 << 32; taken += 1 << 20) {
        char *block = malloc(1 << 20);
        if (!block)
            return error_set(reason, "name: ended at %s", taken <= 64 << 20 ? "its limit" : "more");
        memset(block, 1, 1 << 20);
    }
    return 0;
}

/* A sanitizer's allocator has its own address space and ends the process instead. */
static void memory_is_limited(void)
{
#ifndef __SANITIZE_ADDRESS__
    expect_failure(take_memory, NULL, "name: ended at its limit");
#else
    (void)take_memory;
    TEST_IGNORE_MESSAGE("not under a sanitizer");
#endif
}

/* --- Meshes --- */

static void same_mesh(const char *path, bool bones)
{
    struct mesh here = {0}, there = {0};
    struct answer a = {0}, b = {0};
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, mesh_import_model(&here, path, bones, &error), error.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, mesh_read_model(&there, path, bones, &error), error.text);
    TEST_ASSERT_EQUAL_INT(bones, there.skeleton != NULL);
    TEST_ASSERT_EQUAL_INT(0, transfer_write(&here, &a));
    TEST_ASSERT_EQUAL_INT(0, transfer_write(&there, &b));
    TEST_ASSERT_EQUAL_UINT64(a.bytes, b.bytes);
    TEST_ASSERT_EQUAL_MEMORY(a.data, b.data, a.bytes);
    mesh_free(&here);
    mesh_free(&there);
    free(a.data);
    free(b.data);
}

static void a_mesh_is_the_same_on_both_sides(void)
{
    same_mesh("build/glmark2/models/cube.3ds", 0);
}

static void a_mesh_with_a_skeleton_is_the_same_on_both_sides(void)
{
    same_mesh("build/assimp/models/X/Testwuson.X", 1);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(answers_come_back_whole);
    RUN_TEST(answers_that_are_too_long_are_refused);
    RUN_TEST(reasons_come_back_as_one_line);
    RUN_TEST(crashes_are_one_line);
    RUN_TEST(endless_work_is_ended);
    RUN_TEST(endless_sleep_is_ended);
    RUN_TEST(memory_is_limited);
    RUN_TEST(a_mesh_is_the_same_on_both_sides);
    RUN_TEST(a_mesh_with_a_skeleton_is_the_same_on_both_sides);
    return UNITY_END();
}
