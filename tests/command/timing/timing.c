/* `triptych bench --stages`: its counts are those of the frames, and its times agree with each other. */
#include "command/support/tool.h"
#include "command/tool/command_line.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
#include <unity.h>

static char path[] = "/tmp/triptych-stages-XXXXXX";
static cJSON *report;

void setUp(void)
{
}

void tearDown(void)
{
    cJSON_Delete(report);
    report = NULL;
}

static void measure(char *threads, char *set)
{
    char stream[] = "tests/data/streams/primitives.tri", text[16384] = "";
    char *arguments[] = {"triptych", "bench",     stream,  "--stages", "--engines", "emulate", "--seconds",
                         "0",        "--threads", threads, "--set",    set,         "--json",  path};
    TEST_ASSERT_EQUAL_INT(STATUS_OK, command_line_run(sizeof arguments / sizeof *arguments, arguments));
    FILE *file = fopen(path, "r");
    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_TRUE(fread(text, 1, sizeof text - 1, file) > 0);
    fclose(file);
    cJSON_Delete(report);
    report = cJSON_Parse(text);
    TEST_ASSERT_NOT_NULL(report);
}

static double number(const char *name)
{
    const cJSON *row = cJSON_GetArrayItem(cJSON_GetObjectItem(report, "stages"), 0);
    const cJSON *value = cJSON_GetObjectItem(row, name);
    TEST_ASSERT_TRUE_MESSAGE(cJSON_IsNumber(value), name);
    return value->valuedouble;
}

static void every_stage_takes_a_part_of_the_time(void)
{
    measure("1", "order=tiles");
    double parts = number("vertex_ns") + number("setup_ns") + number("geometry_ns") + number("tiles_ns") +
                   number("pixel_ns");
    TEST_ASSERT_TRUE(number("vertex_ns") > 0 && number("setup_ns") > 0 && number("pixel_ns") > 0);
    TEST_ASSERT_TRUE(number("resolve_ns") > 0);
    TEST_ASSERT_TRUE(parts >= number("all_ns") * 0.999);
    TEST_ASSERT_EQUAL_STRING("", cJSON_GetStringValue(cJSON_GetObjectItem(report, "settings")));
}

static int bench(char *option, char *threads)
{
    char stream[] = "tests/data/streams/primitives.tri";
    char *arguments[] = {"triptych", "bench",     stream,  "--curve", "--engines", "emulate", "--seconds",
                         "0",        "--threads", threads, "--json",  path,        option};
    return command_line_run(sizeof arguments / sizeof *arguments - !option, arguments);
}

static void a_curve_has_a_row_for_each_number_of_threads(void)
{
    static const double numbers[] = {1, 2, 3};
    char text[16384] = "";
    TEST_ASSERT_EQUAL_INT(STATUS_BAD, bench(NULL, "3"));
    TEST_ASSERT_EQUAL_INT(STATUS_OK, bench("--stages", "3"));
    FILE *file = fopen(path, "r");
    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_TRUE(fread(text, 1, sizeof text - 1, file) > 0);
    fclose(file);
    report = cJSON_Parse(text);
    const cJSON *rows = cJSON_GetObjectItem(report, "stages");
    TEST_ASSERT_EQUAL_INT(3, cJSON_GetArraySize(rows));
    for (int i = 0; i < 3; i++) {
        const cJSON *row = cJSON_GetArrayItem(rows, i);
        TEST_ASSERT_TRUE(numbers[i] == cJSON_GetNumberValue(cJSON_GetObjectItem(row, "threads")));
        TEST_ASSERT_TRUE(cJSON_GetNumberValue(cJSON_GetObjectItem(row, "frame_ns")) > 0);
    }
}

static void idle_time_is_a_share(void)
{
    measure("2", "order=stripes");
    TEST_ASSERT_TRUE(number("geometry_idle") >= 0 && number("geometry_idle") < 1);
    TEST_ASSERT_TRUE(number("tiles_idle") >= 0 && number("tiles_idle") < 1);
    TEST_ASSERT_EQUAL_STRING("order=stripes", cJSON_GetStringValue(cJSON_GetObjectItem(report, "settings")));
}

static void counts_do_not_depend_on_threads_and_order(void)
{
    measure("1", "order=tiles");
    double triangles = number("triangles_set_up"), visible = number("triangles_visible");
    double pixels = number("pixels_shaded"), pairs = number("tile_triangles");
    TEST_ASSERT_TRUE(triangles >= visible && visible > 0 && pairs >= visible && pixels > 0);
    measure("2", "order=stripes");
    TEST_ASSERT_TRUE(triangles == number("triangles_set_up") && visible == number("triangles_visible"));
    TEST_ASSERT_TRUE(pixels == number("pixels_shaded") && pairs == number("tile_triangles"));
}

static void smaller_batches_shade_vertices_again(void)
{
    measure("1", "batch=whole");
    double whole = number("vertices_shaded"), read = number("vertices_read");
    measure("1", "batch=6");
    TEST_ASSERT_TRUE(number("vertices_shaded") > whole);
    TEST_ASSERT_TRUE(number("vertices_read") == read && read > 0);
}

int main(void)
{
    int file = mkstemp(path);
    if (file < 0 || close(file))
        return 1;
    UNITY_BEGIN();
    RUN_TEST(every_stage_takes_a_part_of_the_time);
    RUN_TEST(a_curve_has_a_row_for_each_number_of_threads);
    RUN_TEST(idle_time_is_a_share);
    RUN_TEST(counts_do_not_depend_on_threads_and_order);
    RUN_TEST(smaller_batches_shade_vertices_again);
    unlink(path);
    return UNITY_END();
}
