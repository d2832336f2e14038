/* The file of TRIPTYCH_STATISTICS (front/common/statistics.h). */
#include "front/common/statistics.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <unity.h>

static triptych_device *renderer;
static char path[64], text[4096];

void setUp(void)
{
    snprintf(path, sizeof path, "/tmp/statistics-%d", (int)getpid());
    remove(path);
    const struct triptych_options options = {.engine = "emulate"};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_device_create(&options, &renderer, NULL, 0));
    setenv("TRIPTYCH_STATISTICS", path, 1);
}

void tearDown(void)
{
    triptych_device_destroy(renderer);
    remove(path);
}

static int read_text(void)
{
    FILE *file = fopen(path, "r");
    if (!file)
        return 0;
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
    return 1;
}

/* The number after the name. */
static double number(const char *name)
{
    char quoted[64];
    snprintf(quoted, sizeof quoted, "\"%s\": ", name);
    const char *at = strstr(text, quoted);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, name);
    return strtod(at + strlen(quoted), NULL);
}

static void frames_and_their_times_are_written_at_the_end(void)
{
    struct front_statistics statistics;
    front_statistics_begin(&statistics);
    front_statistics_frame(&statistics, renderer);
    usleep(20000);
    front_statistics_frame(&statistics, renderer);
    front_statistics_frame(&statistics, renderer);
    TEST_ASSERT_FALSE(read_text());
    front_statistics_end(&statistics, renderer);
    TEST_ASSERT_TRUE(read_text());
    TEST_ASSERT_NOT_NULL(strstr(text, "\"engine\": \"emulate\""));
    TEST_ASSERT_EQUAL_DOUBLE(3, number("frames"));
    TEST_ASSERT_TRUE(number("longest_frame_ms") >= 20);
    TEST_ASSERT_TRUE(number("total_ms") >= number("longest_frame_ms"));
    TEST_ASSERT_EQUAL_DOUBLE(0, number("draws"));
    TEST_ASSERT_EQUAL_DOUBLE(0, number("pixel"));
}

static void a_frame_after_a_second_writes_the_file(void)
{
    struct front_statistics statistics;
    front_statistics_begin(&statistics);
    front_statistics_frame(&statistics, renderer);
    statistics.written_ns -= 2000000000u;
    front_statistics_frame(&statistics, renderer);
    TEST_ASSERT_TRUE(read_text());
    TEST_ASSERT_EQUAL_DOUBLE(2, number("frames"));
    front_statistics_end(&statistics, renderer);
}

static void draw_triangle(void)
{
    static const struct triptych_declaration_element elements[] = {
        {0, 0, TRIPTYCH_FORMAT_FLOAT4, TRIPTYCH_USAGE_POSITION, 0}};
    static const float corners[3][4] = {{0, 0, 0, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_set_target(renderer, 8, 8));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_set_state(renderer, TRIPTYCH_STATE_LIGHTING, 0));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_set_state(renderer, TRIPTYCH_STATE_CULLMODE, 1));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_set_declaration(renderer, elements, 1));
    TEST_ASSERT_EQUAL_INT(
        TRIPTYCH_OK, triptych_draw_user(renderer, TRIPTYCH_TRIANGLE_LIST, 1, corners, sizeof corners[0]));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_end_frame(renderer));
}

/* The second frame draws with the routines of one state, which the first frame built; the third frame is not
 * counted. */
static void routines_of_a_counted_frame_are_those_that_its_draws_use(void)
{
    struct front_statistics statistics;
    front_statistics_begin(&statistics);
    draw_triangle();
    front_statistics_frame(&statistics, renderer);
    draw_triangle();
    front_statistics_frame(&statistics, renderer);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_set_state(renderer, TRIPTYCH_STATE_COLORWRITEENABLE, 7));
    draw_triangle();
    front_statistics_frame(&statistics, renderer);
    front_statistics_end(&statistics, renderer);
    TEST_ASSERT_TRUE(read_text());
    TEST_ASSERT_EQUAL_DOUBLE(3, number("draws"));
    TEST_ASSERT_EQUAL_DOUBLE(3, number("routines_of_a_frame"));
    TEST_ASSERT_EQUAL_DOUBLE(2, number("pixel"));
}

static void a_device_without_frames_writes_nothing(void)
{
    struct front_statistics statistics;
    front_statistics_begin(&statistics);
    front_statistics_end(&statistics, renderer);
    TEST_ASSERT_FALSE(read_text());
}

static void without_a_file_nothing_is_measured(void)
{
    struct front_statistics statistics;
    setenv("TRIPTYCH_STATISTICS", "", 1);
    front_statistics_begin(&statistics);
    front_statistics_frame(&statistics, renderer);
    front_statistics_end(&statistics, renderer);
    TEST_ASSERT_EQUAL_UINT64(0, statistics.frames);
}

static void a_file_that_cannot_be_written_ends_the_measurement(void)
{
    struct front_statistics statistics;
    setenv("TRIPTYCH_STATISTICS", "/nonexistent/statistics", 1);
    front_statistics_begin(&statistics);
    front_statistics_frame(&statistics, renderer);
    front_statistics_end(&statistics, renderer);
    TEST_ASSERT_NULL(statistics.path);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(frames_and_their_times_are_written_at_the_end);
    RUN_TEST(a_frame_after_a_second_writes_the_file);
    RUN_TEST(routines_of_a_counted_frame_are_those_that_its_draws_use);
    RUN_TEST(a_device_without_frames_writes_nothing);
    RUN_TEST(without_a_file_nothing_is_measured);
    RUN_TEST(a_file_that_cannot_be_written_ends_the_measurement);
    return UNITY_END();
}
