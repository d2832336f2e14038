/* Randomly damaged streams. Each is refused with one line at a position, or is a valid stream. Valid streams
 * are written and read again, and some are played. Builds with sanitizers check the memory accesses. The seed
 * is fixed. */
#include "base/file.h"
#include "command/stream/stream.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <unity.h>

enum { MUTATIONS = 3000, PIXELS_PLAYED = 1 << 16, CALLS_PLAYED = 200 };

static uint64_t seed;
static struct error error;

void setUp(void)
{
    error_clear(&error);
    seed = 0x9e3779b97f4a7c15;
}

void tearDown(void)
{
}

/* xorshift64* */
static uint32_t next_random(uint32_t below)
{
    seed ^= seed >> 12;
    seed ^= seed << 25;
    seed ^= seed >> 27;
    return (uint32_t)((seed * 0x2545f4914f6cdd1d) >> 32) % below;
}

/* Replacements of a byte, word or line. Words of the format reach more code of the reader than random
 * bytes. */
static const char *const pieces[] = {
    "0",
    "1",
    "-1",
    "65535",
    "65536",
    "4294967295",
    "8192",
    "1e38",
    "1e39",
    "nan",
    "0x1p-149",
    "none",
    "{",
    "}",
    "\"",
    "#",
    "\n",
    " ",
    "\\",
    "frame",
    "end",
    "play",
    "sequence",
    "draw",
    "mesh",
    "bind",
    "vertices",
    "float4",
    "color",
    "ffffffff",
    "0x",
    "\xff",
    "\xc3\xa9",
    "transform world rotate 0 0 0 0",
    "position:float3",
    "target 1 1\n",
    "strip",
    "texture m 2d A8R8G8B8 4 4 mips gradient\n",
    "cube",
    "volume",
    "DXT1",
    "levels",
    "mips",
    "update m",
    "fill",
    "on",
    "inverse",
    "vertexshader",
    "pixelshader none\n",
    "vertexconstant 0 transform",
    "r0",
    "oC0",
};

static size_t insert(char *text, size_t bytes, size_t at, const char *piece)
{
    size_t length = strlen(piece);
    memmove(text + at + length, text + at, bytes - at);
    memcpy(text + at, piece, length);
    return bytes + length;
}

static size_t delete (char *text, size_t bytes, size_t at, size_t count)
{
    if (count > bytes - at)
        count = bytes - at;
    memmove(text + at, text + at + count, bytes - at - count);
    return bytes - count;
}

static size_t word_end(const char *text, size_t bytes, size_t at)
{
    while (at < bytes && text[at] != ' ' && text[at] != '\n')
        at++;
    return at;
}

/* Makes one random change, for which the buffer has room. Returns the new length. */
static size_t mutate(char *text, size_t bytes)
{
    static const size_t piece_count = sizeof pieces / sizeof *pieces;
    size_t at = next_random((uint32_t)bytes + 1);
    const char *piece = pieces[next_random((uint32_t)piece_count)];
    switch (next_random(6)) {
    case 0: return insert(text, bytes, at, piece);
    case 1: return delete (text, bytes, at, 1 + next_random(8));
    case 2: return at; /* cut off */
    case 3:
        if (at < bytes)
            text[at] ^= (char)(1 << next_random(8));
        return bytes;
    case 4: /* a word for a word */
        at = word_end(text, bytes, at);
        at += at < bytes;
        bytes = delete (text, bytes, at, word_end(text, bytes, at) - at);
        return insert(text, bytes, at, piece);
    default: { /* a line twice */
        char line[256];
        size_t end = at;
        while (at > 0 && text[at - 1] != '\n')
            at--;
        while (end < bytes && text[end] != '\n')
            end++;
        snprintf(line, sizeof line, "%.*s\n", (int)(end - at), text + at);
        return insert(text, bytes, at, line);
    }
    }
}

static void expect_one_line(const char *path)
{
    TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(path, error.text, strlen(path), error.text);
    TEST_ASSERT_NULL_MESSAGE(strchr(error.text, '\n'), error.text);
    unsigned line, column;
    TEST_ASSERT_EQUAL_INT_MESSAGE(2, sscanf(error.text + strlen(path), ":%u:%u: ", &line, &column),
                                  error.text);
}

static void expect_survives_writing(const struct stream *stream, const char *path)
{
    struct stream *again;
    char *once, *twice;
    size_t bytes;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_write(stream, path, &once, &bytes, &error), error.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_parse(path, once, bytes, &again, &error), error.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_write(again, path, &twice, &bytes, &error), error.text);
    TEST_ASSERT_EQUAL_STRING(once, twice);
    TEST_ASSERT_EQUAL_UINT(stream->executed_count, again->executed_count);
    stream_free(again);
    free(once);
    free(twice);
}

/* The device must accept every stream that passes the checks. */
static void expect_plays(const struct stream *stream)
{
    static const struct triptych_options options = {.engine = "emulate", .threads = 1};
    triptych_device *device;
    for (uint32_t i = 0; i < stream->call_count; i++)
        if (stream->calls[i].type == CALL_TARGET &&
            stream->calls[i].target.width * stream->calls[i].target.height > PIXELS_PLAYED)
            return;
    if (stream->executed_count > CALLS_PLAYED)
        return;
    TEST_ASSERT_EQUAL_INT(0, triptych_device_create(&options, &device, NULL, 0));
    int result = stream_play(stream, device, 0, stream->frame_count - 1, NULL, NULL, &error);
    triptych_device_destroy(device);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, result, error.text);
}

static void survive(const char *path, int mutations)
{
    char *original, *text;
    size_t original_bytes;
    int good = 0, bad = 0;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, file_read(path, 1 << 20, &original, &original_bytes, &error),
                                  error.text);
    text = malloc(original_bytes + 4096);
    TEST_ASSERT_NOT_NULL(text);
    for (int i = 0; i < mutations; i++) {
        struct stream *stream;
        size_t bytes = original_bytes;
        memcpy(text, original, bytes);
        for (uint32_t changes = 1 + next_random(3); changes; changes--)
            bytes = mutate(text, bytes);
        error_clear(&error);
        if (stream_parse(path, text, bytes, &stream, &error)) {
            expect_one_line(path);
            bad++;
            continue;
        }
        expect_survives_writing(stream, path);
        if (++good % 4 == 0)
            expect_plays(stream);
        stream_free(stream);
    }
    /* If nearly all mutations had the same outcome, the test would prove little. */
    TEST_ASSERT_TRUE(good > mutations / 50);
    TEST_ASSERT_TRUE(bad > mutations / 50);
    free(original);
    free(text);
}

static void frames_and_sequences_survive(void)
{
    survive("tests/data/streams/frames.tri", MUTATIONS);
}

static void vertices_and_buffers_survive(void)
{
    survive("tests/data/streams/vertex-buffers.tri", MUTATIONS);
}

static void lights_survive(void)
{
    survive("tests/data/streams/lights.tri", MUTATIONS / 4);
}

static void shaders_survive(void)
{
    survive("tests/data/streams/shaders.tri", MUTATIONS / 2);
}

static void assets_survive(void)
{
    survive("tests/data/streams/meshes.tri", MUTATIONS / 30);
}

/* --- Damaged patch files -------------------------------------------------------------------------------- */

static void damaged_patches_survive(void)
{
    char path[] = "/tmp/triptych-mutate.XXXXXX", use[128];
    char *original, *text;
    size_t original_bytes;
    TEST_ASSERT_EQUAL_INT(
        0, file_read("bench/streams/assets/teapot.bez", 1 << 20, &original, &original_bytes, &error));
    text = malloc(original_bytes + 4096);
    close(mkstemp(path));
    snprintf(use, sizeof use, "triptych 1\nmesh m bezier \"%s\" subdivisions 2\nbind vertices m\n", path);
    for (int i = 0; i < 300; i++) {
        struct stream *stream;
        memcpy(text, original, original_bytes);
        size_t bytes = mutate(text, original_bytes);
        TEST_ASSERT_EQUAL_INT(0, file_write(path, text, bytes, &error));
        error_clear(&error);
        if (stream_parse("m.tri", use, strlen(use), &stream, &error))
            expect_one_line("m.tri");
        stream_free(stream);
    }
    remove(path);
    free(original);
    free(text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(frames_and_sequences_survive);
    RUN_TEST(vertices_and_buffers_survive);
    RUN_TEST(lights_survive);
    RUN_TEST(shaders_survive);
    RUN_TEST(assets_survive);
    RUN_TEST(damaged_patches_survive);
    return UNITY_END();
}
