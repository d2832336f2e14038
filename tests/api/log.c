/* The log function receives failures and warnings, and the ends of frames of recordings are those that the
 * program has marked. */
#include "triptych.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <unity.h>

enum { SIDE = 8, FRAMES = 8 };

static triptych_device *device;
static char folder[64], file[96];

/* The last event that the log function received. */
static struct {
    unsigned count;
    void *user;
    enum triptych_log_level level;
    char text[512];
} event;

static void keep_event(void *user, enum triptych_log_level level, const char *text)
{
    event.count++;
    event.user = user;
    event.level = level;
    snprintf(event.text, sizeof event.text, "%s", text);
}

static void good(enum triptych_result result)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, result, triptych_error(device));
}

void setUp(void)
{
    const struct triptych_options options = {
        .engine = "emulate", .threads = 1, .log = keep_event, .log_user = folder};
    memset(&event, 0, sizeof event);
    strcpy(folder, "/tmp/triptych-log.XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    snprintf(file, sizeof file, "%s/a.trib", folder);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_device_create(&options, &device, NULL, 0));
    good(triptych_set_target(device, SIDE, SIDE));
}

void tearDown(void)
{
    triptych_device_destroy(device);
    unlink(file);
    rmdir(folder);
}

static void a_failed_call_is_logged_with_its_reason(void)
{
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_set_state(device, TRIPTYCH_STATE_CULLMODE, 9));
    TEST_ASSERT_EQUAL_UINT(1, event.count);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_LOG_ERROR, event.level);
    TEST_ASSERT_EQUAL_STRING(triptych_error(device), event.text);
    TEST_ASSERT_EQUAL_PTR(folder, event.user);
}

static void a_number_that_is_not_the_bits_of_a_float_is_a_warning(void)
{
    good(triptych_set_state(device, TRIPTYCH_STATE_FOGEND, triptych_float_bits(2)));
    good(triptych_set_state(device, TRIPTYCH_STATE_FOGEND, triptych_float_bits(0)));
    good(triptych_set_state(device, TRIPTYCH_STATE_ALPHAREF, 1));
    TEST_ASSERT_EQUAL_UINT(0, event.count);
    good(triptych_set_state(device, TRIPTYCH_STATE_FOGEND, 1));
    TEST_ASSERT_EQUAL_UINT(1, event.count);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_LOG_WARNING, event.level);
    TEST_ASSERT_EQUAL_STRING(
        "state fogend: value 1 is the bits of a float near 0, expected triptych_float_bits()", event.text);
}

static void the_log_function_can_be_changed_and_removed(void)
{
    triptych_set_log(device, NULL, NULL);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_set_state(device, TRIPTYCH_STATE_CULLMODE, 9));
    TEST_ASSERT_EQUAL_UINT(0, event.count);
    triptych_set_log(device, keep_event, file);
    triptych_set_log(NULL, keep_event, NULL);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_draw(device, TRIPTYCH_PRIMITIVE_COUNT, 0, 1));
    TEST_ASSERT_EQUAL_PTR(file, event.user);
}

/* Draws frames as a program that shows them does. */
static void draw_frames(unsigned frames, int read, int end)
{
    uint32_t pixels[SIDE * SIDE];
    for (unsigned frame = 0; frame < frames; frame++) {
        const float color[4] = {(float)frame / FRAMES, 0, 0, 1};
        good(triptych_clear(device, color, 1));
        if (read)
            good(triptych_read_color(device, pixels, sizeof pixels));
        else
            good(triptych_finish(device));
        if (end)
            good(triptych_end_frame(device));
    }
}

static void a_recording_without_ends_of_frames_is_a_warning(void)
{
    for (int read = 0; read < 2; read++) {
        event.count = 0;
        good(triptych_record_start(device, file));
        draw_frames(FRAMES, read, 0);
        good(triptych_record_stop(device));
        TEST_ASSERT_EQUAL_UINT(1, event.count);
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_LOG_WARNING, event.level);
        TEST_ASSERT_EQUAL_STRING("the recording is one frame, although pixels were read or finished 8 times: "
                                 "expected triptych_end_frame after each frame",
                                 event.text);
    }
}

static void a_recording_with_ends_of_frames_has_no_warning(void)
{
    good(triptych_record_start(device, file));
    draw_frames(FRAMES, 1, 1);
    good(triptych_record_stop(device));
    TEST_ASSERT_EQUAL_UINT(0, event.count);
}

static void a_recording_of_one_frame_has_no_warning(void)
{
    uint32_t pixels[SIDE * SIDE];
    good(triptych_record_start(device, file));
    draw_frames(1, 1, 0);
    good(triptych_read_color(device, pixels, sizeof pixels));
    good(triptych_record_stop(device));
    TEST_ASSERT_EQUAL_UINT(0, event.count);
}

static void a_recording_that_fails_at_the_end_of_its_device_is_logged(void)
{
    good(triptych_record_start(device, "/dev/full"));
    draw_frames(1, 0, 1);
    triptych_device_destroy(device);
    device = NULL;
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_LOG_ERROR, event.level);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(event.text, "/dev/full: cannot write"), event.text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_failed_call_is_logged_with_its_reason);
    RUN_TEST(a_number_that_is_not_the_bits_of_a_float_is_a_warning);
    RUN_TEST(the_log_function_can_be_changed_and_removed);
    RUN_TEST(a_recording_without_ends_of_frames_is_a_warning);
    RUN_TEST(a_recording_with_ends_of_frames_has_no_warning);
    RUN_TEST(a_recording_of_one_frame_has_no_warning);
    RUN_TEST(a_recording_that_fails_at_the_end_of_its_device_is_logged);
    return UNITY_END();
}
