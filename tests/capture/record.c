/* Recordings play the same pictures that the device has drawn, whenever the recording begins. Failures to
 * write are reported, and leave no file. */
#include "base/file.h"
#include "capture/chunk.h"
#include "command/container/container.h"

#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#include <unity.h>
#include <xxhash.h>

static const char engine[] = "specialize";

static struct error error;
static char folder[64], file[96];
static triptych_device *device;

static triptych_device *open_device(void)
{
    triptych_device *made;
    const struct triptych_options options = {.engine = engine, .threads = 1};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_device_create(&options, &made, NULL, 0));
    return made;
}

void setUp(void)
{
    error_clear(&error);
    strcpy(folder, "/tmp/triptych-record.XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    snprintf(file, sizeof file, "%s/a.trib", folder);
    device = open_device();
}

void tearDown(void)
{
    triptych_device_destroy(device);
    unlink(file);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, rmdir(folder), "temporary files are left");
}

static void good(enum triptych_result result)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, result, triptych_error(device));
}

/* Everything that a device draws to. */
static uint64_t digest(triptych_device *of)
{
    size_t bytes = triptych_contents_bytes(of);
    void *data = malloc(bytes + 1);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, bytes ? triptych_read_contents(of, data, bytes) : TRIPTYCH_OK);
    uint64_t hash = XXH3_64bits(data, bytes);
    free(data);
    return hash;
}

static struct stream *read_stream(const char *path)
{
    struct stream *stream;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_read(path, &stream, &error), error.text);
    return stream;
}

/* Plays all frames of the recording on a device of its own. */
static void expect_frames(const uint64_t *expected, uint32_t count)
{
    struct stream *stream = read_stream(file);
    triptych_device *other = open_device();
    struct player *player;
    TEST_ASSERT_EQUAL_UINT(count, stream->frame_count);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_prepare(stream, other, &player, &error), error.text);
    for (uint32_t frame = 0; frame < count; frame++) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, player_frame(player, frame, &error), error.text);
        TEST_ASSERT_EQUAL_HEX64(expected[frame], digest(other));
    }
    player_free(player);
    triptych_device_destroy(other);
    stream_free(stream);
}

/* --- Streams -------------------------------------------------------------------------------------------- */

enum { FRAMES = 8 };

/* Records frame `from` and the following ones. */
static void expect_recorded(const char *path, uint32_t from)
{
    struct stream *stream = read_stream(path);
    struct player *player;
    uint64_t expected[FRAMES];
    uint32_t count = stream->frame_count < FRAMES ? stream->frame_count : FRAMES;
    if (!from)
        good(triptych_record_start(device, file));
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_prepare(stream, device, &player, &error), error.text);
    for (uint32_t frame = 0; frame < count; frame++) {
        if (frame == from && from)
            good(triptych_record_start(device, file));
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, player_frame(player, frame, &error), error.text);
        expected[frame] = digest(device);
    }
    player_free(player);
    good(triptych_record_stop(device));
    expect_frames(expected + from, count - from);
    stream_free(stream);
    unlink(file);
}

static const char *const streams[] = {
    "tests/data/streams/frames.tri",         "tests/data/streams/queries.tri",
    "tests/data/streams/depth-formats.tri",  "tests/data/streams/multisampling.tri",
    "tests/data/streams/scissors.tri",       "tests/data/streams/render-to-texture.tri",
    "tests/data/streams/target-formats.tri", "tests/data/streams/shaders.tri",
    "tests/data/streams/buffer-changes.tri", "tests/data/streams/rectangles.tri",
};

static void recordings_of_streams_draw_the_same(void)
{
    for (size_t i = 0; i < sizeof streams / sizeof *streams; i++)
        expect_recorded(streams[i], 0);
}

/* The recording begins with the state after earlier frames: the picture, changed textures, textures that were
 * drawn to, and all states. */
static void recordings_may_begin_late(void)
{
    unsigned found = 0;
    for (size_t i = 0; i < sizeof streams / sizeof *streams; i++) {
        struct stream *stream = read_stream(streams[i]);
        uint32_t frames = stream->frame_count;
        stream_free(stream);
        for (uint32_t from = 1; from < frames && from < 3; from++, found++) {
            expect_recorded(streams[i], from);
            triptych_device_destroy(device);
            device = open_device();
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT(8, found);
}

/* --- The interface -------------------------------------------------------------------------------------- */

static const float corners[3][3] = {{-1, -1, 0.5f}, {1, -1, 0.5f}, {0, 1, 0.5f}};
static const float black[4] = {0, 0, 0, 1};

static triptych_buffer *begin_scene(unsigned samples)
{
    triptych_buffer *buffer;
    const struct triptych_target_description target = {
        .width = 33, .height = 17, .depth_format = TRIPTYCH_DEPTH_D24S8, .samples = samples};
    good(triptych_set_target_description(device, &target));
    good(triptych_buffer_create(device, corners, sizeof corners, &buffer));
    good(triptych_set_state(device, TRIPTYCH_STATE_LIGHTING, 0));
    good(triptych_set_state(device, TRIPTYCH_STATE_CULLMODE, 1));
    good(triptych_set_element(device, TRIPTYCH_POSITION,
                              &(struct triptych_element){TRIPTYCH_FORMAT_FLOAT3, buffer, 0, 12}));
    return buffer;
}

static void end_frame(uint64_t *expected)
{
    good(triptych_end_frame(device));
    *expected = digest(device);
}

/* The recording begins in the middle of a frame, with partly covered samples and a texture whose contents its
 * format cannot represent. */
static void a_recording_may_begin_between_two_draws(void)
{
    uint64_t expected[2];
    uint32_t dxt[2] = {0xf800001f, 0xe4e4e4e4};
    triptych_texture *texture;
    const struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_DXT1, 4, 4, 1, 0};
    begin_scene(4);
    good(triptych_texture_define(device, &description, &texture));
    good(triptych_texture_update(device, texture, 0, 0, NULL, dxt, 8, 8));
    good(triptych_texture_generate_mips(device, texture));
    good(triptych_set_texture(device, 0, texture));
    good(triptych_set_state(device, TRIPTYCH_STATE_STENCILENABLE, 1));
    good(triptych_set_state(device, TRIPTYCH_STATE_STENCILPASS, 7));
    good(triptych_clear_buffers(device, 7, black, 0.75f, 3));
    good(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    good(triptych_record_start(device, file));
    good(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    end_frame(&expected[0]);
    good(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    end_frame(&expected[1]);
    good(triptych_record_stop(device));
    expect_frames(expected, 2);
}

/* Draws a triangle of a mapped buffer, and the next one before the buffer is unmapped. */
static void draw_mapped(triptych_buffer *buffer, enum triptych_map mode)
{
    float *at;
    void *data;
    good(triptych_buffer_map(device, buffer, 0, sizeof corners, mode, &data));
    memcpy(data, corners, sizeof corners);
    at = data;
    at[0] = -0.5f;
    good(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    at[2 * 3] = (float)mode / 4;
    if (mode != TRIPTYCH_MAP_NO_OVERWRITE)
        good(triptych_finish(device));
    good(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    good(triptych_buffer_unmap(device, buffer));
}

/* The recording begins while a buffer is mapped. */
static void changes_of_buffers_are_recorded(void)
{
    static const struct triptych_declaration_element declaration[] = {
        {0, 0, TRIPTYCH_FORMAT_FLOAT3, TRIPTYCH_USAGE_POSITION, 0},
        {0, 12, TRIPTYCH_FORMAT_COLOR, TRIPTYCH_USAGE_COLOR, 0},
        {0, 400, TRIPTYCH_FORMAT_FLOAT2, TRIPTYCH_USAGE_NORMAL, 9}};
    const struct {
        float position[3];
        uint32_t color;
    } vertex[3] = {{{-1, 1, 0}, 0xff00ff00}, {{1, 1, 0}, 0xff0000ff}, {{0, 0, 0}, 0xffff0000}};
    uint64_t expected[3];
    void *data;
    triptych_buffer *buffer = begin_scene(0), *others;
    good(triptych_buffer_create(device, NULL, 30, &others));
    good(triptych_clear_buffers(device, 7, black, 1, 0));
    good(triptych_buffer_map(device, others, 10, 20, TRIPTYCH_MAP_WRITE, &data));
    good(triptych_record_start(device, file));
    memset(data, 1, 20);
    good(triptych_buffer_unmap(device, others));
    draw_mapped(buffer, TRIPTYCH_MAP_WRITE);
    end_frame(&expected[0]);
    draw_mapped(buffer, TRIPTYCH_MAP_DISCARD);
    good(triptych_buffer_update(device, buffer, 4, &vertex[0].position[1], 4));
    good(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    end_frame(&expected[1]);
    good(triptych_set_declaration(device, declaration, 3));
    good(triptych_draw_user(device, TRIPTYCH_TRIANGLE_LIST, 1, vertex, sizeof *vertex));
    good(triptych_draw_indexed_user(device, TRIPTYCH_LINE_LIST, 1, (uint8_t[]){2, 0}, 8, 3, vertex,
                                    sizeof *vertex));
    end_frame(&expected[2]);
    good(triptych_record_stop(device));
    expect_frames(expected, 3);
}

/* How many calls of the recording have the type. */
static unsigned calls_of(enum call_type type)
{
    unsigned count = 0;
    struct stream *stream = read_stream(file);
    for (uint32_t i = 0; i < stream->call_count; i++)
        count += stream->calls[i].type == type;
    stream_free(stream);
    return count;
}

/* Offsets that are whole words have the older form. */
static void declarations_of_any_alignment_are_recorded(void)
{
    static const struct triptych_declaration_element odd[] = {
        {0, 3, TRIPTYCH_FORMAT_BYTE3, TRIPTYCH_USAGE_POSITION, 0},
        {0, 0, TRIPTYCH_FORMAT_UBYTE3N, TRIPTYCH_USAGE_COLOR, 0}};
    static const struct triptych_declaration_element even[] = {
        {0, 4, TRIPTYCH_FORMAT_INT2, TRIPTYCH_USAGE_POSITION, 0},
        {0, 0, TRIPTYCH_FORMAT_UBYTE3N, TRIPTYCH_USAGE_COLOR, 0}};
    static const uint8_t vertex[3][6] = {
        {255, 128, 0, 255, 1, 0}, {0, 128, 255, 1, 1, 0}, {255, 255, 255, 0, 255, 0}};
    static const int32_t whole[3][3] = {{255, -1, 1}, {255, 1, 1}, {255, 0, -1}};
    uint64_t expected[2];
    triptych_buffer *buffer;
    begin_scene(0);
    good(triptych_buffer_create(device, vertex, sizeof vertex, &buffer));
    good(triptych_record_start(device, file));
    good(triptych_clear(device, black, 1));
    good(triptych_set_declaration(device, odd, 2));
    good(triptych_set_stream(device, 0, buffer, 0, sizeof *vertex));
    good(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    good(triptych_draw_user(device, TRIPTYCH_TRIANGLE_LIST, 1, vertex, sizeof *vertex));
    end_frame(&expected[0]);
    good(triptych_clear(device, black, 1));
    good(triptych_set_declaration(device, even, 2));
    good(triptych_draw_user(device, TRIPTYCH_TRIANGLE_LIST, 1, whole, sizeof *whole));
    end_frame(&expected[1]);
    good(triptych_record_stop(device));
    TEST_ASSERT_TRUE(expected[0] != expected[1]);
    expect_frames(expected, 2);
    TEST_ASSERT_EQUAL_UINT(1, calls_of(CALL_DECLARE_BYTES));
    TEST_ASSERT_TRUE(calls_of(CALL_DECLARE) >= 1);
}

static void unread_attributes_may_exceed_their_buffers(void)
{
    static const struct triptych_declaration_element declaration[] = {
        {0, 0, TRIPTYCH_FORMAT_FLOAT3, TRIPTYCH_USAGE_POSITION, 0},
        {1, 0, TRIPTYCH_FORMAT_FLOAT2, TRIPTYCH_USAGE_TEXCOORD, 0},
        {2, 0, TRIPTYCH_FORMAT_FLOAT2, TRIPTYCH_USAGE_NORMAL, 9},
    };
    uint64_t expected[2];
    triptych_buffer *buffer = begin_scene(1), *tiny;
    good(triptych_buffer_create(device, corners, 8, &tiny));
    good(triptych_record_start(device, file));
    good(triptych_set_declaration(device, declaration, 3));
    good(triptych_set_stream(device, 0, buffer, 0, 12));
    good(triptych_set_stream(device, 1, tiny, 0, 8));
    good(triptych_clear(device, black, 1));
    good(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    end_frame(&expected[0]);
    good(triptych_buffer_destroy(device, tiny));
    good(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    end_frame(&expected[1]);
    good(triptych_record_stop(device));
    expect_frames(expected, 2);
}

/* Numbers of destroyed resources are used again, so a recording can have more resources than numbers. */
static void numbers_of_destroyed_resources_are_used_again(void)
{
    uint64_t expected[3];
    begin_scene(1);
    good(triptych_record_start(device, file));
    for (int frame = 0; frame < 3; frame++) {
        triptych_buffer *buffer, *indices;
        triptych_texture *texture;
        triptych_query *query;
        static const uint16_t order[] = {2, 1, 0};
        uint32_t texels[4] = {0xff0000ff, 0xff00ff00, 0xffff0000, (uint32_t)frame * 0x11111111};
        good(triptych_buffer_create(device, corners, sizeof corners, &buffer));
        good(triptych_buffer_create(device, order, sizeof order, &indices));
        good(triptych_texture_create(device, texels, 2, 2, &texture));
        good(triptych_query_create(device, TRIPTYCH_QUERY_OCCLUSION, &query));
        good(triptych_set_element(device, TRIPTYCH_POSITION,
                                  &(struct triptych_element){TRIPTYCH_FORMAT_FLOAT3, buffer, 0, 12}));
        good(triptych_set_element(device, TRIPTYCH_TEXCOORD,
                                  &(struct triptych_element){TRIPTYCH_FORMAT_FLOAT2, buffer, 1, 12}));
        good(triptych_set_indices(device, indices, 16));
        good(triptych_set_texture(device, 0, texture));
        good(triptych_clear(device, black, 1));
        good(triptych_query_begin(device, query));
        good(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 0, 1));
        end_frame(&expected[frame]);
        good(triptych_query_end(device, query));
        good(triptych_query_destroy(device, query));
        good(triptych_buffer_destroy(device, buffer));
        good(triptych_buffer_destroy(device, indices));
        good(triptych_texture_destroy(device, texture));
    }
    good(triptych_record_stop(device));
    expect_frames(expected, 3);
}

/* --- Files ---------------------------------------------------------------------------------------------- */

static void there_is_no_file_before_the_end(void)
{
    struct stat status;
    begin_scene(1);
    good(triptych_record_start(device, file));
    good(triptych_clear(device, black, 1));
    TEST_ASSERT_EQUAL_INT(-1, stat(file, &status));
    good(triptych_record_stop(device));
    TEST_ASSERT_EQUAL_INT(0, stat(file, &status));
    struct stream *stream = read_stream(file);
    TEST_ASSERT_EQUAL_UINT(1, stream->frame_count);
    stream_free(stream);
}

/* Reads the temporary file as `convert --salvage` does after the program was killed. */
static uint32_t frames_in_file(void)
{
    char pattern[128];
    glob_t found;
    struct stream *stream;
    snprintf(pattern, sizeof pattern, "%s/*.new", folder);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, glob(pattern, 0, NULL, &found), pattern);
    int result = container_read(found.gl_pathv[0], CONTAINER_SALVAGE, &stream, &error);
    globfree(&found);
    if (result)
        return 0;
    uint32_t frames = stream->frame_count;
    stream_free(stream);
    return frames;
}

static void frames_reach_the_file_before_the_end(void)
{
    const struct timespec longer = {.tv_nsec = CHUNK_NANOSECONDS + 20000000};
    begin_scene(1);
    good(triptych_record_start(device, file));
    for (uint32_t frame = 1; frame <= 3; frame++) {
        good(triptych_clear(device, black, 1));
        good(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
        nanosleep(&longer, NULL);
        good(triptych_end_frame(device));
        TEST_ASSERT_EQUAL_UINT32(frame, frames_in_file());
    }
    good(triptych_record_stop(device));
    struct stream *stream = read_stream(file);
    TEST_ASSERT_EQUAL_UINT(3, stream->frame_count);
    stream_free(stream);
}

static void wrong_calls_are_refused(void)
{
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_record_stop(device));
    TEST_ASSERT_NOT_NULL(strstr(triptych_error(device), "no calls are recorded"));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_record_start(device, NULL));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_record_start(device, ""));
    TEST_ASSERT_EQUAL_STRING("\"\": is not a path, expected that of a file", triptych_error(device));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_record_start(device, "/nowhere/a.trib"));
    TEST_ASSERT_NOT_NULL(strstr(triptych_error(device), "/nowhere/a.trib: cannot write"));
    good(triptych_record_start(device, file));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_record_start(device, file));
    good(triptych_record_stop(device));
}

/* Calls are still executed. The failure is reported at the end. */
static void a_full_disk_is_reported_at_the_end(void)
{
    if (access("/dev/full", W_OK))
        TEST_IGNORE_MESSAGE("there is no /dev/full");
    begin_scene(1);
    good(triptych_record_start(device, "/dev/full"));
    good(triptych_clear(device, black, 1));
    good(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    good(triptych_finish(device));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_FILE_FAILED, triptych_record_stop(device));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(triptych_error(device), "/dev/full: cannot write"),
                                 triptych_error(device));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_record_stop(device));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(recordings_of_streams_draw_the_same);
    RUN_TEST(recordings_may_begin_late);
    RUN_TEST(a_recording_may_begin_between_two_draws);
    RUN_TEST(changes_of_buffers_are_recorded);
    RUN_TEST(declarations_of_any_alignment_are_recorded);
    RUN_TEST(unread_attributes_may_exceed_their_buffers);
    RUN_TEST(numbers_of_destroyed_resources_are_used_again);
    RUN_TEST(there_is_no_file_before_the_end);
    RUN_TEST(frames_reach_the_file_before_the_end);
    RUN_TEST(wrong_calls_are_refused);
    RUN_TEST(a_full_disk_is_reported_at_the_end);
    return UNITY_END();
}
