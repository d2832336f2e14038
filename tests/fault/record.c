/* Refuses each request of the recorder once. The draws must succeed. In the end there must be either a
 * complete capture that plays to the same picture, or no capture and a line with the reason. */
#define _GNU_SOURCE
#include "tests/support/system/fault.h"

#include "base/file.h"
#include "command/stream/stream.h"
#include "tests/support/system/seed.h"
#include "triptych.h"

#include <dirent.h>
#include <unity.h>

enum { SIDE = 16, TEXELS = 8, LIVES = 70 };

static char folder[] = "/dev/shm/triptych-record-XXXXXX";
static char path[64];
static triptych_device *device;
static uint32_t expected[SIDE * SIDE], got[SIDE * SIDE];

void setUp(void)
{
}

void tearDown(void)
{
    fault_disarm();
    fault.watching = false;
    triptych_device_destroy(device);
    device = NULL;
    unlink(path);
}

/* A call whose request is refused must change nothing. It is repeated; the refusal does not happen again. */
#define DO(call)                                                                                             \
    do {                                                                                                     \
        enum triptych_result result = call;                                                                  \
        if (result == TRIPTYCH_NO_MEMORY)                                                                    \
            result = call;                                                                                   \
        TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, result, triptych_error(device));                          \
    } while (0)

static triptych_buffer *make_triangle(float depth)
{
    const float corners[3][4] = {{-1, -1, depth, 1}, {0, 1, depth, 1}, {1, -0.8f, depth, 1}};
    triptych_buffer *buffer;
    DO(triptych_buffer_create(device, corners, sizeof corners, &buffer));
    return buffer;
}

static void draw_once(float depth)
{
    struct triptych_element element = {.format = TRIPTYCH_FORMAT_FLOAT4, .stride = 16};
    element.buffer = make_triangle(depth);
    DO(triptych_set_element(device, TRIPTYCH_POSITION, &element));
    DO(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    DO(triptych_buffer_destroy(device, element.buffer));
}

/* Draws a scene. The recording begins when objects already exist, and many are created and destroyed after
 * that. Returns the result of the recording's end, and in `started` the result of its start. */
static enum triptych_result draw(enum triptych_result *started)
{
    static const char text[] =
        "ps_2_0\ndef c1, 0.25, 0.5, 0, 0\ndcl t0\ndcl_2d s0\ntexld r0, t0, s0\nadd r0, r0, c1\n"
        "mov oC0, r0\n";
    static uint32_t texels[TEXELS * TEXELS];
    struct triptych_options options = {.engine = "emulate", .threads = 1};
    triptych_texture *texture;
    triptych_shader *shader;
    triptych_query *query;
    uint64_t passed;
    for (unsigned i = 0; i < TEXELS * TEXELS; i++)
        texels[i] = 0xff000000u | i * 0x30507u;
    if (triptych_device_create(&options, &device, NULL, 0))
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_device_create(&options, &device, NULL, 0));
    DO(triptych_set_target(device, SIDE, SIDE));
    DO(triptych_set_state(device, TRIPTYCH_STATE_CULLMODE, 1));
    DO(triptych_texture_create(device, texels, TEXELS, TEXELS, &texture));
    DO(triptych_set_texture(device, 0, texture));
    DO(triptych_shader_assemble(device, "shader", text, strlen(text), &shader));
    DO(triptych_set_pixel_shader(device, shader));
    DO(triptych_clear(device, (const float[4]){0, 0, 1, 1}, 1));
    draw_once(0.5f);
    *started = triptych_record_start(device, path);
    DO(triptych_query_create(device, TRIPTYCH_QUERY_OCCLUSION, &query));
    DO(triptych_query_begin(device, query));
    for (unsigned i = 0; i < LIVES; i++)
        draw_once(0.4f - (float)i / (4 * LIVES));
    DO(triptych_query_end(device, query));
    DO(triptych_texture_update(device, texture, 0, 0, &(struct triptych_box){2, 2, 0, 4, 4, 1}, texels, 16,
                               64));
    draw_once(0.01f);
    DO(triptych_query_result(device, query, &passed));
    DO(triptych_finish(device));
    DO(triptych_read_color(device, got, sizeof got));
    return *started ? TRIPTYCH_OK : triptych_record_stop(device);
}

static int read_back(void *user, uint32_t frame, triptych_device *of, struct error *error)
{
    (void)user, (void)frame, (void)error;
    return triptych_read_color(of, got, sizeof got);
}

/* The recording's last frame is the picture. */
static void expect_recording(const char *message)
{
    struct triptych_options options = {.engine = "emulate", .threads = 1};
    struct error error = {{0}};
    struct stream *stream;
    triptych_device *player;
    memset(got, 0, sizeof got);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_read(path, &stream, &error), error.text);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_device_create(&options, &player, NULL, 0));
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        0, stream_play(stream, player, 0, stream->frame_count - 1, read_back, NULL, &error), error.text);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(expected, got, sizeof got, message);
    triptych_device_destroy(player);
    stream_free(stream);
}

static unsigned files(void)
{
    unsigned count = 0;
    DIR *entries = opendir(folder);
    for (struct dirent *entry; (entry = readdir(entries));)
        count += entry->d_name[0] != '.';
    closedir(entries);
    return count;
}

/* Returns true if a request of the run was refused. */
static bool refuse(unsigned long at)
{
    char message[600];
    enum triptych_result started;
    fault_watch();
    fault_arm(at, false);
    enum triptych_result stopped = draw(&started);
    fault_disarm();
    const char *told = triptych_error(device);
    snprintf(message, sizeof message, "request %lu: started %d, stopped %d, %s", at, started, stopped, told);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(expected, got, sizeof got, message);
    if (started || stopped) {
        TEST_ASSERT_TRUE_MESSAGE(fault.refused && strstr(told, "memory"), message);
        TEST_ASSERT_EQUAL_INT_MESSAGE(started ? TRIPTYCH_NO_MEMORY : TRIPTYCH_FILE_FAILED,
                                      started ? started : stopped, message);
    }
    TEST_ASSERT_EQUAL_UINT_MESSAGE(!started && !stopped, files(), message);
    triptych_device_destroy(device);
    device = NULL;
    const char *lost = fault_lost();
    TEST_ASSERT_NULL_MESSAGE(lost, lost);
    if (!started && !stopped)
        expect_recording(message);
    unlink(path);
    return fault.refused;
}

static void test_a_capture_is_whole_or_missing(void)
{
    enum triptych_result started;
    unsigned long at = 1;
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, draw(&started));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, started);
    memcpy(expected, got, sizeof got);
    triptych_device_destroy(device);
    device = NULL;
    expect_recording("undisturbed");
    while (refuse(at))
        at += test_stride_of(5);
    TEST_ASSERT_GREATER_THAN(100, at);
    printf("%lu requests refused at %u places\n", fault.total, fault_sites->count);
}

static void remove_files(void)
{
    char name[512];
    DIR *entries = opendir(folder);
    for (struct dirent *entry; (entry = readdir(entries));)
        if (entry->d_name[0] != '.') {
            snprintf(name, sizeof name, "%s/%s", folder, entry->d_name);
            unlink(name);
        }
    closedir(entries);
}

/* If the environment requests a recording of a device, the device is created with its recording or not at
 * all. */
static void test_devices_that_the_environment_records(void)
{
    struct triptych_options options = {.engine = "emulate", .threads = 1};
    enum triptych_result result = TRIPTYCH_NO_MEMORY;
    char reason[512];
    setenv("TRIPTYCH_RECORD", path, 1);
    for (unsigned long at = 1; result; at += test_stride_of(5)) {
        fault_watch();
        fault_arm(at, false);
        result = triptych_device_create(&options, &device, reason, sizeof reason);
        fault_disarm();
        if (result) {
            TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_NO_MEMORY, result, reason);
            TEST_ASSERT_NULL(device);
            TEST_ASSERT_EQUAL_UINT_MESSAGE(0, files(), reason);
        }
        result = fault.refused && !result ? TRIPTYCH_NO_MEMORY : result; /* it may succeed after a refusal */
        triptych_device_destroy(device);
        device = NULL;
        const char *lost = fault_lost();
        TEST_ASSERT_NULL_MESSAGE(lost, lost);
        remove_files();
    }
    unsetenv("TRIPTYCH_RECORD");
}

int main(void)
{
    UNITY_BEGIN();
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/recording.trib", folder);
    RUN_TEST(test_a_capture_is_whole_or_missing);
    RUN_TEST(test_devices_that_the_environment_records);
    rmdir(folder);
    return UNITY_END();
}
