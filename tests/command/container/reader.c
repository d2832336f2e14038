/* Recordings that are read during playing. They give the same pictures as recordings that are read as a
 * whole, in any order of frames, and the memory does not grow with their length. */
#include "capture/chunk.h"
#include "base/file.h"
#include "command/container/reader.h"

#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <unity.h>
#include <xxhash.h>

enum { FRAMES = 6, SIDE = 40 };

static struct error error;
static char folder[64], file[96];
static triptych_device *device;

static triptych_device *open_device(void)
{
    triptych_device *made;
    const struct triptych_options options = {.engine = "specialize", .threads = 1};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_device_create(&options, &made, NULL, 0));
    return made;
}

void setUp(void)
{
    error_clear(&error);
    strcpy(folder, "/tmp/triptych-reader.XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    snprintf(file, sizeof file, "%s/a.trib", folder);
    device = open_device();
}

void tearDown(void)
{
    triptych_device_destroy(device);
    unlink(file);
    TEST_ASSERT_EQUAL_INT(0, rmdir(folder));
}

static void good(enum triptych_result result)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, result, triptych_error(device));
}

static uint64_t digest(triptych_device *of)
{
    uint32_t pixels[SIDE * SIDE];
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_read_color(of, pixels, sizeof pixels));
    return XXH3_64bits(pixels, sizeof pixels);
}

/* Records frames that clear the target and have different pictures. Every frame creates its own resources.
 * Every second frame keeps its texture for the next one. */
static void record_frames(uint64_t expected[FRAMES])
{
    static const float black[4] = {0, 0, 0, 1};
    triptych_texture *texture = NULL;
    good(triptych_record_start(device, file));
    good(triptych_set_target(device, SIDE, SIDE));
    good(triptych_set_state(device, TRIPTYCH_STATE_LIGHTING, 0));
    good(triptych_set_state(device, TRIPTYCH_STATE_CULLMODE, 1));
    for (int frame = 0; frame < FRAMES; frame++) {
        const float x = (float)frame / FRAMES, corners[3][3] = {{-1, -1, 0}, {1, -1, 0}, {x, 1 - x, 0}};
        const uint32_t texels[4] = {0xff0000ff, 0xff00ffff, 0xffffff00, 0xff004080u + (unsigned)frame};
        triptych_buffer *buffer;
        good(triptych_buffer_create(device, corners, sizeof corners, &buffer));
        if (!texture) {
            good(triptych_texture_create(device, texels, 2, 2, &texture));
            good(triptych_set_texture(device, 0, texture));
        }
        for (int a = 0; a < 2; a++)
            good(triptych_set_element(
                device, a ? TRIPTYCH_TEXCOORD : TRIPTYCH_POSITION,
                &(struct triptych_element){a ? TRIPTYCH_FORMAT_FLOAT2 : TRIPTYCH_FORMAT_FLOAT3, buffer, 0,
                                           12}));
        good(triptych_clear(device, black, 1));
        good(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
        good(triptych_end_frame(device));
        expected[frame] = digest(device);
        good(triptych_buffer_destroy(device, buffer));
        if (frame % 2) {
            good(triptych_texture_destroy(device, texture));
            texture = NULL;
        }
    }
    good(triptych_record_stop(device));
}

static struct stream *open_stream(void)
{
    struct stream *stream;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, container_open(file, &stream, &error), error.text);
    return stream;
}

static void frames_are_the_same_in_any_order(void)
{
    static const uint32_t order[] = {0, 1, 5, 2, 2, 4, 0, 3};
    uint64_t expected[FRAMES];
    struct player *player;
    record_frames(expected);
    struct stream *stream = open_stream();
    TEST_ASSERT_TRUE(stream->streamed);
    TEST_ASSERT_EQUAL_UINT(FRAMES, stream->frame_count);
    triptych_device *other = open_device();
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_prepare(stream, other, &player, &error), error.text);
    for (size_t i = 0; i < sizeof order / sizeof *order; i++) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, player_frame(player, order[i], &error), error.text);
        TEST_ASSERT_EQUAL_HEX64(expected[order[i]], digest(other));
    }
    TEST_ASSERT_EQUAL_INT(-1, player_frame(player, FRAMES, &error));
    player_free(player);
    triptych_device_destroy(other);
    stream_free(stream);
}

/* The recording creates and destroys buffers of a hundred megabytes in sum. */
static void memory_does_not_grow_with_the_length(void)
{
    enum { MEGABYTE = 1 << 20, COUNT = 100, BOUND = 12 };
    uint32_t *data = malloc(MEGABYTE);
    good(triptych_record_start(device, file));
    good(triptych_set_target(device, SIDE, SIDE));
    for (uint32_t i = 0; i < COUNT; i++) {
        triptych_buffer *buffer;
        for (uint32_t word = 0; word < MEGABYTE / 4; word++)
            data[word] = word / 64 * i;
        good(triptych_buffer_create(device, data, MEGABYTE, &buffer));
        good(triptych_clear(device, (const float[4]){0}, 1));
        good(triptych_end_frame(device));
        good(triptych_buffer_destroy(device, buffer));
    }
    good(triptych_record_stop(device));
    free(data);

    struct stream *stream = open_stream();
    size_t before = mallinfo2().uordblks + mallinfo2().hblkhd, most = 0;
    struct stream_reader *reader = reader_create(stream, &error);
    struct step step = {.type = RECORD_IS_CALL};
    uint32_t frames = 0;
    while (step.type != RECORD_NONE) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, reader_next(reader, &step, &error), error.text);
        size_t now = mallinfo2().uordblks + mallinfo2().hblkhd;
        most = now > most ? now : most;
        frames += step.type == RECORD_IS_CALL && step.call.type == CALL_FRAME;
        if (step.type == RECORD_IS_CALL && step.call.type == CALL_RELEASE)
            reader_release(reader, step.call.resource);
    }
    TEST_ASSERT_EQUAL_UINT(COUNT, frames);
    reader_free(reader);
    stream_free(stream);
    if (!most)
        TEST_IGNORE_MESSAGE("memory is not counted here");
    TEST_ASSERT_LESS_THAN_UINT64((uint64_t)BOUND << 20, most - before);
}

/* Frames before the damage are played. */
static void damage_is_found_when_it_is_reached(void)
{
    uint64_t expected[FRAMES];
    struct player *player;
    char *data;
    size_t bytes;
    record_frames(expected);
    TEST_ASSERT_EQUAL_INT(0, file_read(file, 1 << 24, &data, &bytes, &error));
    data[bytes - CHUNK_HEADER - CHUNK_END - 8] ^= 1;
    TEST_ASSERT_EQUAL_INT(0, file_write(file, data, bytes, &error));
    struct stream *stream = open_stream();
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_prepare(stream, device, &player, &error), error.text);
    TEST_ASSERT_EQUAL_INT(-1, player_frame(player, 0, &error));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, "a.trib: offset 16 (chunk 0): found another checksum"),
                                 error.text);
    player_free(player);
    stream_free(stream);
    error_clear(&error);
    TEST_ASSERT_EQUAL_INT(0, file_write(file, data, bytes - 1, &error));
    TEST_ASSERT_EQUAL_INT(-1, container_open(file, &stream, &error));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, "found no end of the container"), error.text);
    free(data);
}

static void other_streams_are_read_whole(void)
{
    struct stream *stream;
    static const char text[] = "triptych 1\ntarget 8 8\nclear depth 1\n";
    TEST_ASSERT_EQUAL_INT(0, file_write(file, text, sizeof text - 1, &error));
    stream = open_stream();
    TEST_ASSERT_FALSE(stream->streamed);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, container_save(stream, file, &error), error.text);
    stream_free(stream);
    stream = open_stream();
    TEST_ASSERT_FALSE(stream->streamed);
    TEST_ASSERT_EQUAL_UINT(2, stream->call_count);
    stream_free(stream);
    TEST_ASSERT_EQUAL_INT(-1, container_open("/nowhere/a.trib", &stream, &error));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(frames_are_the_same_in_any_order);
    RUN_TEST(memory_does_not_grow_with_the_length);
    RUN_TEST(damage_is_found_when_it_is_reached);
    RUN_TEST(other_streams_are_read_whole);
    return UNITY_END();
}
