/* `triptych verify` finds planted differences: the linker wraps the functions that read a target (see the
 * Makefile), and the wrappers change one word of one picture. */
#include "command/support/tool.h"
#include "command/tool/command_line.h"
#include "triptych.h"

#include <unity.h>

#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The stream has 5 frames of 48 x 64. With `--engines emulate --threads 1,2` each frame is read twice: by the
 * reference, then by the configuration with two threads. */
enum { WIDTH = 48, X = 7, Y = 3, READS = 10, NEVER = READS };

static struct {
    int color_read, depth_read;       /* the number of reads so far */
    int color_plant, depth_plant;     /* the read to change */
    bool stencil_plant, number_plant; /* if true, the next read is changed */
} planted;

enum triptych_result __real_triptych_read_color(triptych_device *device, uint32_t *rgba, size_t bytes);
enum triptych_result __real_triptych_read_depth(triptych_device *device, float *depth, size_t bytes);
enum triptych_result __real_triptych_read_stencil(triptych_device *device, uint8_t *stencil, size_t bytes);
enum triptych_result __real_triptych_read_target_numbers(triptych_device *device, unsigned target,
                                                         float *numbers, size_t bytes);
enum triptych_result __wrap_triptych_read_stencil(triptych_device *device, uint8_t *stencil, size_t bytes);
enum triptych_result __wrap_triptych_read_target_numbers(triptych_device *device, unsigned target,
                                                         float *numbers, size_t bytes);
enum triptych_result __wrap_triptych_read_color(triptych_device *device, uint32_t *rgba, size_t bytes);
enum triptych_result __wrap_triptych_read_depth(triptych_device *device, float *depth, size_t bytes);

enum triptych_result __wrap_triptych_read_color(triptych_device *device, uint32_t *rgba, size_t bytes)
{
    enum triptych_result result = __real_triptych_read_color(device, rgba, bytes);
    if (planted.color_read++ == planted.color_plant)
        rgba[Y * WIDTH + X] ^= 0x100;
    return result;
}

enum triptych_result __wrap_triptych_read_depth(triptych_device *device, float *depth, size_t bytes)
{
    enum triptych_result result = __real_triptych_read_depth(device, depth, bytes);
    if (planted.depth_read++ == planted.depth_plant)
        ((uint32_t *)depth)[Y * WIDTH + X] ^= 1;
    return result;
}

enum triptych_result __wrap_triptych_read_stencil(triptych_device *device, uint8_t *stencil, size_t bytes)
{
    enum triptych_result result = __real_triptych_read_stencil(device, stencil, bytes);
    if (planted.stencil_plant)
        stencil[Y] ^= 1;
    planted.stencil_plant = false;
    return result;
}

enum triptych_result __wrap_triptych_read_target_numbers(triptych_device *device, unsigned target,
                                                         float *numbers, size_t bytes)
{
    enum triptych_result result = __real_triptych_read_target_numbers(device, target, numbers, bytes);
    if (planted.number_plant)
        ((uint32_t *)numbers)[4 * Y + 1] ^= 1;
    planted.number_plant = false;
    return result;
}

static char folder[] = "/tmp/triptych-verify-XXXXXX";
static char report_path[64], painting_path[96];
static cJSON *report;

/* With `settings`, unless it is null, one thread and these settings; otherwise one thread and two. */
static int verify_with(char *stream, char *settings)
{
    char *arguments[] = {"triptych",  "verify", stream,      "--engines",  "emulate",
                         "--threads", "1,2",    "--frames",  "all",        "--difference",
                         folder,      "--json", report_path, "--settings", settings};
    int count = (int)(sizeof arguments / sizeof *arguments);
    if (settings)
        arguments[6] = "1";
    int status = command_line_run(settings ? count : count - 2, arguments);
    char text[16384] = "";
    FILE *file = fopen(report_path, "r");
    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_TRUE(fread(text, 1, sizeof text - 1, file) > 0);
    fclose(file);
    report = cJSON_Parse(text);
    TEST_ASSERT_NOT_NULL(report);
    return status;
}

static int verify_stream(char *stream)
{
    return verify_with(stream, NULL);
}

static int verify(void)
{
    return verify_stream("tests/data/streams/frames.tri");
}

static const cJSON *difference(void)
{
    const cJSON *stream = cJSON_GetArrayItem(cJSON_GetObjectItem(report, "streams"), 0);
    const cJSON *differences = cJSON_GetObjectItem(stream, "differences");
    TEST_ASSERT_EQUAL_INT(1, cJSON_GetArraySize(differences));
    return cJSON_GetArrayItem(differences, 0);
}

static int number(const char *name)
{
    return (int)cJSON_GetNumberValue(cJSON_GetObjectItem(difference(), name));
}

void setUp(void)
{
    memset(&planted, 0, sizeof planted);
    planted.color_plant = planted.depth_plant = NEVER;
    unlink(painting_path);
}

void tearDown(void)
{
    cJSON_Delete(report);
    report = NULL;
}

static void test_without_a_plant_all_is_identical(void)
{
    TEST_ASSERT_EQUAL_INT(STATUS_OK, verify());
    TEST_ASSERT_TRUE(cJSON_IsTrue(cJSON_GetObjectItem(report, "identical")));
    TEST_ASSERT_EQUAL_INT(READS, planted.color_read);
    TEST_ASSERT_EQUAL_INT(READS, planted.depth_read);
}

static void check_frame_2(int color_pixels, int depth_pixels)
{
    TEST_ASSERT_EQUAL_INT(STATUS_DIFFERENT, verify());
    TEST_ASSERT_TRUE(cJSON_IsFalse(cJSON_GetObjectItem(report, "identical")));
    TEST_ASSERT_EQUAL_INT(2, number("frame"));
    TEST_ASSERT_EQUAL_INT(2, number("threads"));
    TEST_ASSERT_EQUAL_INT(X, number("x"));
    TEST_ASSERT_EQUAL_INT(Y, number("y"));
    TEST_ASSERT_EQUAL_INT(color_pixels, number("color_pixels"));
    TEST_ASSERT_EQUAL_INT(depth_pixels, number("depth_pixels"));
    TEST_ASSERT_EQUAL_INT(0, access(painting_path, R_OK));
}

static void test_one_bit_of_colour_is_found(void)
{
    planted.color_plant = 5;
    check_frame_2(1, 0);
}

static void test_one_bit_of_depth_is_found(void)
{
    planted.depth_plant = 5;
    check_frame_2(0, 1);
}

static void test_a_wrong_reference_is_found_too(void)
{
    planted.color_plant = 4;
    check_frame_2(1, 0);
}

/* Each frame is read by the reference, with stripes, and draw by draw. */
static void test_a_setting_that_changes_a_bit_is_named(void)
{
    planted.color_plant = 4;
    planted.depth_plant = -1;
    TEST_ASSERT_EQUAL_INT(STATUS_DIFFERENT, verify_with("tests/data/streams/frames.tri", "order"));
    TEST_ASSERT_EQUAL_INT(1, number("frame"));
    TEST_ASSERT_EQUAL_INT(1, number("threads"));
    TEST_ASSERT_EQUAL_STRING("order=stripes",
                             cJSON_GetStringValue(cJSON_GetObjectItem(difference(), "settings")));
    TEST_ASSERT_EQUAL_INT(3, cJSON_GetArraySize(cJSON_GetObjectItem(report, "settings")));
}

static void test_a_setting_that_does_not_exist_is_refused(void)
{
    char *arguments[] = {"triptych",   "verify", "tests/data/streams/frames.tri", "--engines", "emulate",
                         "--settings", "oder"};
    TEST_ASSERT_EQUAL_INT(STATUS_BAD, command_line_run(sizeof arguments / sizeof *arguments, arguments));
}

/* Expects one changed pixel, at Y in the first row, and a count of 1 with this name; the rest is equal. */
static void check_one_pixel_of(const char *count)
{
    TEST_ASSERT_TRUE(cJSON_IsFalse(cJSON_GetObjectItem(report, "identical")));
    TEST_ASSERT_EQUAL_INT(Y, number("x"));
    TEST_ASSERT_EQUAL_INT(0, number("y"));
    TEST_ASSERT_EQUAL_INT(0, number("color_pixels"));
    TEST_ASSERT_EQUAL_INT(0, number("depth_pixels"));
    TEST_ASSERT_EQUAL_INT(1, number(count));
}

static void test_one_bit_of_stencil_is_found(void)
{
    planted.stencil_plant = true;
    TEST_ASSERT_EQUAL_INT(STATUS_DIFFERENT, verify_stream("tests/data/streams/stencil-operations.tri"));
    check_one_pixel_of("stencil_pixels");
}

static void test_one_bit_of_a_number_is_found(void)
{
    planted.number_plant = true;
    TEST_ASSERT_EQUAL_INT(STATUS_DIFFERENT, verify_stream("tests/data/streams/targets.tri"));
    check_one_pixel_of("number_pixels");
}

int main(void)
{
    if (!mkdtemp(folder))
        return 1;
    snprintf(report_path, sizeof report_path, "%s/report.json", folder);
    snprintf(painting_path, sizeof painting_path, "%s/frames-emulate-2-frame-2.png", folder);
    UNITY_BEGIN();
    RUN_TEST(test_without_a_plant_all_is_identical);
    RUN_TEST(test_one_bit_of_colour_is_found);
    RUN_TEST(test_one_bit_of_depth_is_found);
    RUN_TEST(test_one_bit_of_stencil_is_found);
    RUN_TEST(test_one_bit_of_a_number_is_found);
    RUN_TEST(test_a_wrong_reference_is_found_too);
    RUN_TEST(test_a_setting_that_changes_a_bit_is_named);
    RUN_TEST(test_a_setting_that_does_not_exist_is_refused);
    unlink(report_path);
    unlink(painting_path);
    rmdir(folder);
    return UNITY_END();
}
