/* `triptych bench --tasks`: its report, and what it refuses. */
#include "command/support/tool.h"
#include "command/tool/command_line.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
#include <unity.h>

static char path[] = "/tmp/triptych-tasks-XXXXXX";
static cJSON *report;

void setUp(void)
{
}

void tearDown(void)
{
    cJSON_Delete(report);
    report = NULL;
}

static int bench(char *set)
{
    char stream[] = "tests/data/streams/primitives.tri";
    char *arguments[] = {"triptych", "bench",         stream, "--tasks", "--engines", "emulate", "--threads",
                         "4",        "--repetitions", "3",    "--json",  path,        "--set",   set};
    return command_line_run(sizeof arguments / sizeof *arguments, arguments);
}

static void read_report(void)
{
    char text[16384] = "";
    FILE *file = fopen(path, "r");
    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_TRUE(fread(text, 1, sizeof text - 1, file) > 0);
    fclose(file);
    report = cJSON_Parse(text);
    TEST_ASSERT_NOT_NULL(report);
}

static double number(const cJSON *object, const char *name)
{
    const cJSON *value = cJSON_GetObjectItem(object, name);
    TEST_ASSERT_TRUE_MESSAGE(cJSON_IsNumber(value), name);
    return value->valuedouble;
}

static void a_row_for_each_number_of_threads_has_the_parts_of_its_time(void)
{
    static const char *const parts[] = {"submit_ns", "cut_ns",   "geometry_ns",
                                        "link_ns",   "tiles_ns", "move_ns"};
    if (sysconf(_SC_NPROCESSORS_ONLN) < 2)
        TEST_IGNORE_MESSAGE("two threads need two processors");
    TEST_ASSERT_EQUAL_INT(STATUS_OK, bench("order=tiles"));
    read_report();
    const cJSON *rows = cJSON_GetObjectItem(report, "tasks");
    TEST_ASSERT_EQUAL_INT(3, cJSON_GetArraySize(rows));
    for (int i = 0; i < 3; i++) {
        const cJSON *row = cJSON_GetArrayItem(rows, i);
        double sum = 0, frame = number(row, "frame_ns");
        for (size_t p = 0; p < sizeof parts / sizeof *parts; p++)
            sum += number(row, parts[p]);
        TEST_ASSERT_EQUAL_DOUBLE(1 << i, number(row, "threads"));
        TEST_ASSERT_DOUBLE_WITHIN(frame * 1e-6, frame, sum);
        TEST_ASSERT_TRUE(number(row, "efficiency") > 0 && number(row, "efficiency") <= 1.000001);
    }
    TEST_ASSERT_TRUE(number(cJSON_GetArrayItem(rows, 0), "speedup") == 1);
    TEST_ASSERT_TRUE(number(cJSON_GetArrayItem(rows, 1), "measured_ns") > 0);
    TEST_ASSERT_TRUE(number(cJSON_GetObjectItem(report, "handover"), "wake_ns") > 0);
}

static void rounds_that_overlap_are_refused(void)
{
    TEST_ASSERT_EQUAL_INT(STATUS_BAD, bench("queue=priority"));
}

int main(void)
{
    int file = mkstemp(path);
    if (file < 0 || close(file))
        return 1;
    UNITY_BEGIN();
    RUN_TEST(a_row_for_each_number_of_threads_has_the_parts_of_its_time);
    RUN_TEST(rounds_that_overlap_are_refused);
    unlink(path);
    return UNITY_END();
}
